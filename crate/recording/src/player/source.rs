//! Files of which any part can be read.

use std::io::{Read, Result};
use std::rc::Rc;

/// Bytes of which any part can be read.
pub trait Source {
    /// How many there are.
    fn length(&self) -> u64;

    /// Reads from byte `at` on, as [`Read::read`] does.
    ///
    /// # Errors
    /// What the file's system says.
    fn read_at(&self, at: u64, into: &mut [u8]) -> Result<usize>;
}

impl Source for Vec<u8> {
    fn length(&self) -> u64 {
        self.len() as u64
    }

    fn read_at(&self, at: u64, into: &mut [u8]) -> Result<usize> {
        let from = usize::try_from(at).unwrap_or(usize::MAX).min(self.len());
        (&self[from..]).read(into)
    }
}

/// The bytes from `at` to `end`, in order.
#[derive(Debug)]
pub(crate) struct Section<S> {
    source: Rc<S>,
    at: u64,
    end: u64,
}

impl<S> Section<S> {
    pub(crate) fn new(source: Rc<S>, at: u64, end: u64) -> Self {
        Self { source, at, end }
    }
}

impl<S: Source> Read for Section<S> {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let most = usize::try_from(self.end.saturating_sub(self.at)).unwrap_or(usize::MAX).min(into.len());
        let read = self.source.read_at(self.at, &mut into[..most])?;
        self.at += read as u64;
        Ok(read)
    }
}

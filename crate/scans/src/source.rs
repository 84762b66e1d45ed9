//! The address of a sensor in a capture.

use std::fmt;
use std::net::{IpAddr, SocketAddr};
use std::str::FromStr;

/// Where a sensor sends from: an address, and a port if two sensors share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceAddress {
    /// IPv4 or IPv6.
    pub ip: IpAddr,
    /// Any if there is none.
    pub port: Option<u16>,
}

impl SourceAddress {
    pub(crate) fn fits(self, address: SocketAddr) -> bool {
        self.ip == address.ip() && self.port.is_none_or(|port| port == address.port())
    }
}

impl fmt::Display for SourceAddress {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.port {
            Some(port) => SocketAddr::new(self.ip, port).fmt(text),
            None => self.ip.fmt(text),
        }
    }
}

/// `192.168.1.201`, `192.168.1.201:2368`, `fe80::1` or `[fe80::1]:2368`.
impl FromStr for SourceAddress {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Ok(ip) = text.parse() {
            return Ok(Self { ip, port: None });
        }
        match text.parse::<SocketAddr>() {
            Ok(address) => Ok(Self { ip: address.ip(), port: Some(address.port()) }),
            Err(_) => Err("expected an address such as 192.168.1.201 or 192.168.1.201:2368".to_owned()),
        }
    }
}

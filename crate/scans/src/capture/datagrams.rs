//! UDP datagrams, put together again where IP took them apart.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::net::{IpAddr, SocketAddr};

use etherparse::defrag::IpDefragBuf;
use etherparse::{
    IpFragOffset, IpNumber, Ipv6ExtensionSlice, LaxNetSlice, LaxSlicedPacket, TransportSlice, UdpSlice,
};

/// Datagrams of which a part is still missing; the oldest is given up for one more.
const MOST_OPEN: usize = 64;
/// Packets of the capture after which an incomplete datagram is given up: its number is used again.
const MOST_PACKETS: usize = 4096;

/// What a packet brings.
pub(crate) enum Arrival<'a> {
    Datagram {
        source: SocketAddr,
        payload: Cow<'a, [u8]>,
    },
    /// A part of a datagram that is not whole yet.
    Fragment,
    /// No UDP.
    Other,
}

/// What tells the fragments of one datagram from all others.
#[derive(PartialEq, Eq)]
struct Identity {
    source: IpAddr,
    destination: IpAddr,
    identification: u32,
}

struct Fragment<'a> {
    identity: Identity,
    offset: IpFragOffset,
    is_last: bool,
    payload: &'a [u8],
}

struct Open {
    identity: Identity,
    /// The packet of the capture that opened it.
    begun: usize,
    fragments: usize,
    buffer: IpDefragBuf,
}

/// Datagrams of which fragments have come.
#[derive(Default)]
pub(crate) struct Datagrams {
    open: VecDeque<Open>,
    given_up: usize,
}

impl Datagrams {
    /// Takes packet `number` of the capture.
    pub(crate) fn take<'a>(&mut self, number: usize, packet: &LaxSlicedPacket<'a>) -> Arrival<'a> {
        let Some((address, payload)) = packet.net.as_ref().and_then(udp_payload) else {
            return Arrival::Other;
        };
        if let Some(fragment) = packet.net.as_ref().and_then(|net| fragment(net, payload)) {
            return self.take_fragment(number, fragment).map_or(Arrival::Fragment, |(source, whole)| {
                let Ok(udp) = UdpSlice::from_slice(&whole) else { return Arrival::Other };
                let source = SocketAddr::new(source, udp.source_port());
                Arrival::Datagram { source, payload: Cow::Owned(udp.payload().to_vec()) }
            });
        }
        match &packet.transport {
            Some(TransportSlice::Udp(udp)) => Arrival::Datagram {
                source: SocketAddr::new(address, udp.source_port()),
                payload: Cow::Borrowed(udp.payload()),
            },
            _ => Arrival::Other,
        }
    }

    /// Fragments whose datagram did not become whole.
    pub(crate) fn fragments_left(&self) -> usize {
        self.given_up + self.open.iter().map(|open| open.fragments).sum::<usize>()
    }

    fn take_fragment(&mut self, number: usize, fragment: Fragment<'_>) -> Option<(IpAddr, Vec<u8>)> {
        while self.open.front().is_some_and(|open| number - open.begun > MOST_PACKETS) {
            self.give_up_oldest();
        }
        let index = match self.open.iter().position(|open| open.identity == fragment.identity) {
            Some(index) => index,
            None => {
                if self.open.len() == MOST_OPEN {
                    self.give_up_oldest();
                }
                let buffer = IpDefragBuf::new(IpNumber::UDP, Vec::new(), Vec::new());
                self.open.push_back(Open {
                    identity: fragment.identity,
                    begun: number,
                    fragments: 0,
                    buffer,
                });
                self.open.len() - 1
            }
        };
        let open = self.open.get_mut(index)?;
        open.fragments += 1;
        // A fragment that does not fit to the others is as good as lost.
        let _ = open.buffer.add(fragment.offset, !fragment.is_last, fragment.payload);
        if !open.buffer.is_complete() {
            return None;
        }
        let whole = self.open.remove(index)?;
        Some((whole.identity.source, whole.buffer.take_bufs().0))
    }

    fn give_up_oldest(&mut self) {
        self.given_up += self.open.pop_front().map_or(0, |open| open.fragments);
    }
}

/// The sender of an IP packet with UDP or a whole fragment of it, and what IP carries.
fn udp_payload<'a>(net: &LaxNetSlice<'a>) -> Option<(IpAddr, &'a [u8])> {
    let (source, payload) = match net {
        LaxNetSlice::Ipv4(ip) => (ip.header().source_addr().into(), ip.payload()),
        LaxNetSlice::Ipv6(ip) => (ip.header().source_addr().into(), ip.payload()),
        LaxNetSlice::Arp(_) => return None,
    };
    let is_whole = payload.ip_number == IpNumber::UDP && !(payload.fragmented && payload.incomplete);
    is_whole.then_some((source, payload.payload))
}

/// The packet as a fragment, if it is one.
fn fragment<'a>(net: &LaxNetSlice<'a>, payload: &'a [u8]) -> Option<Fragment<'a>> {
    match net {
        LaxNetSlice::Ipv4(ip) => {
            let header = ip.header();
            header.is_fragmenting_payload().then(|| Fragment {
                identity: Identity {
                    source: header.source_addr().into(),
                    destination: header.destination_addr().into(),
                    identification: header.identification().into(),
                },
                offset: header.fragments_offset(),
                is_last: !header.more_fragments(),
                payload,
            })
        }
        LaxNetSlice::Ipv6(ip) => {
            let header = ip.header();
            let part = ip.extensions().clone().into_iter().find_map(|extension| match extension {
                Ipv6ExtensionSlice::Fragment(part) if part.is_fragmenting_payload() => Some(part),
                _ => None,
            })?;
            Some(Fragment {
                identity: Identity {
                    source: header.source_addr().into(),
                    destination: header.destination_addr().into(),
                    identification: part.identification(),
                },
                offset: part.fragment_offset(),
                is_last: !part.more_fragments(),
                payload,
            })
        }
        LaxNetSlice::Arp(_) => None,
    }
}

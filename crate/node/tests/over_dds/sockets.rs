//! Sockets of a process, as Linux tells.

/// Addresses with their ports at which the process has sockets, by a table such as `udp`; an address as
/// `0100007F:1CE8`.
pub(crate) fn bound(process: u32, table: &str) -> Vec<(String, u16)> {
    let links = std::fs::read_dir(format!("/proc/{process}/fd")).unwrap();
    let links = links.filter_map(|link| std::fs::read_link(link.ok()?.path()).ok());
    let sockets: Vec<String> = links.map(|link| link.display().to_string()).collect();
    let rows = std::fs::read_to_string(format!("/proc/{process}/net/{table}")).unwrap();
    let rows = rows.lines().skip(1).map(|row| row.split_whitespace().collect::<Vec<_>>());
    let own = rows.filter(|row| sockets.contains(&format!("socket:[{}]", row[9])));
    let port = |address: &str| u16::from_str_radix(address.rsplit_once(':').unwrap().1, 16).unwrap();
    own.map(|row| (row[1].to_owned(), port(row[1]))).collect()
}

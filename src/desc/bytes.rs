//! Files as bytes: decompressed if their name ends in `.gz`.

use std::io::{self, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

/// The content of a file; of one whose name ends in `.gz`, decompressed. Never more than `most` bytes.
///
/// # Errors
///
/// What the system says; `InvalidData` for a broken archive, `FileTooLarge` for content longer than `most`.
pub(super) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut content = std::fs::read(path)?;
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz")) {
        let mut plain = Vec::new();
        MultiGzDecoder::new(content.as_slice())
            .take(most.saturating_add(1))
            .read_to_end(&mut plain)
            .map_err(|e| io::Error::new(io::ErrorKind::InvalidData, format!("not a valid gzip archive ({e})")))?;
        content = plain;
    }
    if content.len() as u64 > most {
        return Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("longer than {most} bytes"),
        ));
    }
    Ok(content)
}

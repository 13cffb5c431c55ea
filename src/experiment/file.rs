//! Files that come from outside: only what is a file is opened, and its size is known before a byte is read.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Bytes of an experiment file, at most: what people write.
pub const WRITTEN: u64 = 8 << 20;

/// Bytes of results and images, at most: what programs write.
pub const STORED: u64 = 2 << 30;

/// The bytes of a file that has at most `most` of them.
///
/// # Errors
///
/// When it cannot be read, has more, or is a folder, a device, a pipe or a socket, some of which never end.
pub fn bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    // a pipe would keep whoever opens it waiting
    let told = fs::metadata(path)?;
    if !told.is_file() {
        let what = if told.is_dir() { "a folder" } else { "a device, a pipe or a socket" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, format!("it is {what}, and no file")));
    }
    let too_large = |has: u64| {
        let why = format!("it has {has} bytes, and at most {most} are read");
        io::Error::new(io::ErrorKind::FileTooLarge, why)
    };
    if told.len() > most {
        return Err(too_large(told.len()));
    }
    let mut bytes = Vec::with_capacity(told.len() as usize);
    // it may grow meanwhile
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(bytes.len() as u64)) } else { Ok(bytes) }
}

/// The text of a file that has at most `most` bytes.
///
/// # Errors
///
/// As [`bytes`], and when it is no UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    let no_text = |e: std::string::FromUtf8Error| {
        let at = e.utf8_error().valid_up_to();
        io::Error::new(io::ErrorKind::InvalidData, format!("it is no UTF-8 text from byte {at} on"))
    };
    String::from_utf8(bytes(path, most)?).map_err(no_text)
}

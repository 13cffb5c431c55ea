//! One line of a journal: its checksum (CRC-32, of all that follows), a word that says what it is, and what it says. Numbers
//! of blocks are bytes as they are in memory, little end first; the two bytes that would end a line or begin an escape are
//! escaped.

use crate::experiment::guard::Failure;
use std::ops::Range;

/// What a line says.
#[derive(Clone, Debug, PartialEq)]
pub enum Line<'a> {
    /// What is sampled, as JSON.
    Header(&'a [u8]),
    /// Blocks of a cell.
    Blocks {
        /// The cell, by its index in the plan.
        cell: usize,
        /// Their numbers.
        numbers: Range<u64>,
        /// What they are; in a line that was read still escaped, see `unescape`.
        bytes: &'a [u8],
    },
    /// A block that could not be made.
    Failed(usize, Failure),
    /// Seconds that were spent on a cell, in addition to those that earlier lines say.
    Seconds(usize, f64),
    /// The run that began with the last header came to its end.
    End,
}

/// Hexadecimal digits of the checksum.
const DIGITS: usize = 8;

/// Begins an escape.
const ESCAPE: u8 = 0x1b;

impl<'a> Line<'a> {
    /// The line with its checksum and its end; the bytes of blocks are escaped on the way.
    pub fn write(&self, to: &mut Vec<u8>) {
        let start = to.len();
        to.extend([b'0'; DIGITS]);
        let text = match self {
            Line::Header(_) => "header ".to_owned(),
            Line::Blocks { cell, numbers, .. } => format!("blocks {cell} {} {} ", numbers.start, numbers.end),
            Line::Failed(cell, failure) => {
                format!("failed {cell} {} {}", failure.block, serde_json::Value::from(failure.why.as_str()))
            }
            Line::Seconds(cell, seconds) => format!("seconds {cell} {seconds}"),
            Line::End => "end".to_owned(),
        };
        to.push(b' ');
        to.extend(text.as_bytes());
        match self {
            Line::Header(json) => to.extend(*json),
            Line::Blocks { bytes, .. } => escape(bytes, to),
            _ => {}
        }
        let sum = crc32fast::hash(&to[start + DIGITS..]);
        to[start..start + DIGITS].copy_from_slice(format!("{sum:08x}").as_bytes());
        to.push(b'\n');
    }

    /// Reads a line with its end; `None` if anything is wrong with it.
    pub fn read(line: &'a [u8]) -> Option<Self> {
        let (sum, rest) = line.strip_suffix(b"\n")?.split_at_checked(DIGITS)?;
        let sum = std::str::from_utf8(sum).ok().filter(|sum| sum.bytes().all(|c| c.is_ascii_hexdigit()))?;
        if u32::from_str_radix(sum, 16).ok()? != crc32fast::hash(rest) {
            return None;
        }
        let (word, rest) = split(rest.strip_prefix(b" ")?);
        match word {
            b"header" => Some(Line::Header(rest)),
            b"blocks" => {
                let (cell, rest) = number(rest)?;
                let (start, rest) = number(rest)?;
                let (end, bytes) = number(rest)?;
                let cell = usize::try_from(cell).ok()?;
                (start < end).then_some(Line::Blocks { cell, numbers: start..end, bytes })
            }
            b"failed" => {
                let (cell, rest) = number(rest)?;
                let (block, why) = number(rest)?;
                let why = serde_json::from_slice(why).ok()?;
                Some(Line::Failed(usize::try_from(cell).ok()?, Failure { block, why }))
            }
            b"seconds" => {
                let (cell, seconds) = number(rest)?;
                let seconds: f64 = std::str::from_utf8(seconds).ok()?.parse().ok()?;
                let is_time = seconds.is_finite() && seconds >= 0.0;
                is_time.then_some(Line::Seconds(usize::try_from(cell).ok()?, seconds))
            }
            b"end" if rest.is_empty() => Some(Line::End),
            _ => None,
        }
    }
}

/// Up to the next space, and what follows it.
fn split(text: &[u8]) -> (&[u8], &[u8]) {
    match memchr::memchr(b' ', text) {
        Some(at) => (&text[..at], &text[at + 1..]),
        None => (text, &[]),
    }
}

fn number(text: &[u8]) -> Option<(u64, &[u8])> {
    let (number, rest) = split(text);
    Some((std::str::from_utf8(number).ok()?.parse().ok()?, rest))
}

/// Appends bytes so that none of them ends a line.
fn escape(bytes: &[u8], to: &mut Vec<u8>) {
    to.reserve(bytes.len() + bytes.len() / 64);
    let mut rest = bytes;
    while let Some(at) = memchr::memchr2(b'\n', ESCAPE, rest) {
        to.extend(&rest[..at]);
        to.extend([ESCAPE, if rest[at] == b'\n' { b'n' } else { b'e' }]);
        rest = &rest[at + 1..];
    }
    to.extend(rest);
}

/// Undoes [`escape`]; `None` if this was not escaped.
pub fn unescape(bytes: &[u8], to: &mut Vec<u8>) -> Option<()> {
    to.clear();
    to.reserve(bytes.len());
    let mut rest = bytes;
    while let Some(at) = memchr::memchr(ESCAPE, rest) {
        to.extend(&rest[..at]);
        to.push(match rest.get(at + 1)? {
            b'n' => b'\n',
            b'e' => ESCAPE,
            _ => return None,
        });
        rest = &rest[at + 2..];
    }
    to.extend(rest);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(line: &Line<'_>) -> Vec<u8> {
        let mut bytes = Vec::new();
        line.write(&mut bytes);
        bytes
    }

    #[test]
    fn all_bytes_survive() {
        let all: Vec<u8> = (0..=255).chain([ESCAPE, ESCAPE, b'\n', b'\n', b'n', b'e']).collect();
        let (mut escaped, mut back) = (Vec::new(), Vec::new());
        escape(&all, &mut escaped);
        assert!(!escaped.contains(&b'\n'));
        unescape(&escaped, &mut back).unwrap();
        assert_eq!(back, all);
        assert_eq!(unescape(&[ESCAPE], &mut back), None);
        assert_eq!(unescape(&[ESCAPE, b'x'], &mut back), None);
    }

    #[test]
    fn lines_are_read_as_they_were_written() {
        let failure = Failure { block: 7, why: "a \"word\"\nand another".to_owned() };
        for line in [
            Line::Header(b"{}"),
            Line::Blocks { cell: 3, numbers: 80..96, bytes: b" none \x00\xff" },
            Line::Failed(2, failure),
            Line::Seconds(1, 0.125),
            Line::End,
        ] {
            let bytes = written(&line);
            assert_eq!(Line::read(&bytes), Some(line));
            assert_eq!(memchr::memchr(b'\n', &bytes), Some(bytes.len() - 1), "one line");
        }
    }

    #[test]
    fn no_changed_bit_and_no_lost_byte_goes_unnoticed() {
        let line = written(&Line::Blocks { cell: 3, numbers: 80..96, bytes: b"some bytes" });
        for at in 0..line.len() {
            assert_eq!(Line::read(&line[..at]), None);
            for bit in 0..8 {
                let mut other = line.clone();
                other[at] ^= 1 << bit;
                // of a digit in the other case the value is the same
                let same = other.eq_ignore_ascii_case(&line) && at < DIGITS;
                assert_eq!(Line::read(&other).is_some(), same, "bit {bit} of byte {at}");
            }
        }
    }
}

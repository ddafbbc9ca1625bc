//! This reader keeps the whole records of a table that was cut off somewhere.

use std::io::{self, Read};

/// Longest record of a table, bytes: a row of a run is below 1 kB, a warning's words below 10 kB. A
/// longer limit would hold more of a hostile file without line ends in memory.
const MAX_RECORD_BYTES: usize = 1 << 20;

/// Bytes read at once.
const CHUNK_BYTES: usize = 1 << 16;

/// Returns where the records of a CSV text end, each after its line end.
pub(crate) fn record_ends(text: &[u8]) -> impl Iterator<Item = usize> {
    let mut quoted = false;
    text.iter().enumerate().filter_map(move |(k, byte)| {
        // Two quotes in a row, which stand for one in a field, change nothing.
        quoted ^= *byte == b'"';
        (*byte == b'\n' && !quoted).then_some(k + 1)
    })
}

/// Passes on the whole records of a CSV text and holds back what follows the last end of a record,
/// since nobody can know whether its last number is all there.
pub struct WholeRecords<R> {
    from: R,
    /// Bytes read; whole records of them are passed on.
    bytes: Vec<u8>,
    /// Number of `bytes` that have been passed on.
    passed: usize,
    /// Number of `bytes` that are whole records.
    whole: usize,
    /// Within quotes, where a line end is part of a text.
    quoted: bool,
    ended: bool,
}

impl<R> std::fmt::Debug for WholeRecords<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WholeRecords")
            .field("passed", &self.passed)
            .field("whole", &self.whole)
            .field("ended", &self.ended)
            .finish_non_exhaustive()
    }
}

impl<R: Read> WholeRecords<R> {
    /// Of a text.
    pub fn new(from: R) -> Self {
        Self { from, bytes: Vec::new(), passed: 0, whole: 0, quoted: false, ended: false }
    }

    /// Bytes after the last whole record, once everything is read.
    #[must_use]
    pub(crate) fn left_out_bytes(&self) -> usize {
        self.bytes.len() - self.whole
    }

    /// Reads the next chunk and finds the end of the last whole record in it.
    fn fill(&mut self) -> io::Result<()> {
        self.bytes.drain(..self.passed);
        self.whole -= self.passed;
        self.passed = 0;
        let known = self.bytes.len();
        if known > MAX_RECORD_BYTES {
            let what = format!("a record has more than {MAX_RECORD_BYTES} bytes");
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        let read = (&mut self.from).take(CHUNK_BYTES as u64).read_to_end(&mut self.bytes)?;
        self.ended = read == 0;
        for (k, byte) in self.bytes.iter().enumerate().skip(known) {
            match byte {
                // Two in a row, which stand for one in a text, change nothing.
                b'"' => self.quoted = !self.quoted,
                b'\n' if !self.quoted => self.whole = k + 1,
                _ => {}
            }
        }
        Ok(())
    }
}

impl<R: Read> Read for WholeRecords<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        while self.passed == self.whole && !self.ended {
            self.fill()?;
        }
        let ready = self.bytes.get(self.passed..self.whole).unwrap_or_default();
        let count = ready.len().min(to.len());
        for (to, byte) in to.iter_mut().zip(ready) {
            *to = *byte;
        }
        self.passed += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A source that gives one byte at a time.
    struct Drops<'a>(&'a [u8]);
    impl Read for Drops<'_> {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            let count = to.len().min(1).min(self.0.len());
            to[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn a_cut_text_ends_with_its_last_whole_record() {
        let text = b"a,b\n1,\"two\nlines, \"\"quoted\"\"\"\n3,4\n";
        let ends = [0, 4, 30, 34];
        for cut in 0..=text.len() {
            let whole = ends.iter().copied().filter(|e| *e <= cut).max().unwrap();
            let mut from = WholeRecords::new(Drops(&text[..cut]));
            let mut out = Vec::new();
            from.read_to_end(&mut out).unwrap();
            assert_eq!(out, &text[..whole], "cut at {cut}");
            assert_eq!(from.left_out_bytes(), cut - whole);
        }
    }

    #[test]
    fn records_end_at_lines_outside_quotes() {
        let text = b"a,b\n1,\"two\nlines, \"\"quoted\"\"\"\n3,4\n5";
        assert_eq!(record_ends(text).collect::<Vec<_>>(), [4, 30, 34]);
    }

    #[test]
    fn long_texts_pass_and_a_record_without_an_end_is_refused() {
        let row = "1.25,2.5\n".repeat(40_000);
        let mut out = String::new();
        WholeRecords::new(row.as_bytes()).read_to_string(&mut out).unwrap();
        assert_eq!(out, row);
        let endless = vec![b'1'; 3 << 20];
        let error = io::copy(&mut WholeRecords::new(endless.as_slice()), &mut io::sink()).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidData);
    }
}

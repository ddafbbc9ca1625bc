//! Pages lay out rows so that none crosses the border between two pages of a file.
//!
//! A system copies what is written into its memory page by page, and a process that is killed may
//! stop between two: of 200 killed runs one to five ended within a line. A row that lies on one
//! page is written whole or not at all. So the last row that fits on a page is made to end with it,
//! by zeros after the digits of its time, which change no number and no reader's mind.

use super::csv_records::record_ends;

/// Bytes of a page: 4096 or a multiple everywhere. Smaller numbers would cost more zeros, larger
/// ones leave rows on two pages.
const PAGE_BYTES: usize = 4096;

/// Most bytes of a number and the comma after it: `-2.2250738585072014e-308,`.
const MAX_NUMBER_BYTES: usize = 25;

/// Layout of the rows of a table on its pages.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pages {
    /// Length of the table, bytes.
    length: usize,
    /// The longest row that such a table can have, bytes.
    longest: usize,
}

impl Pages {
    /// The rows to be written next, in parts that are written with one call each. A row that is
    /// longer than a page still lies on two pages, and so does a row after a header that nearly
    /// fills a page.
    pub(crate) fn lay_out(&mut self, rows: &[u8]) -> Vec<Vec<u8>> {
        let mut parts = vec![Vec::new()];
        let (mut from, mut row_start) = (0, 0);
        for to in record_ends(rows) {
            let row = rows.get(from..to).unwrap_or_default();
            from = to;
            self.longest = self.longest.max(longest_like(row));
            if row.len() > self.room() {
                self.fill(&mut parts, row_start, row.len());
                parts.push(Vec::new());
            } else if self.room() == PAGE_BYTES {
                parts.push(Vec::new());
            }
            if let Some(part) = parts.last_mut() {
                row_start = part.len();
                part.extend_from_slice(row);
            }
            self.length += row.len();
        }
        if self.room() < self.longest {
            self.fill(&mut parts, row_start, 0);
        }
        parts.retain(|part| !part.is_empty());
        parts
    }

    /// Bytes left on the page.
    fn room(&self) -> usize {
        PAGE_BYTES - self.length % PAGE_BYTES
    }

    /// Lengthens the last row to the end of its page, unless what follows is longer than a page.
    fn fill(&mut self, parts: &mut [Vec<u8>], row_start: usize, next: usize) {
        let room = self.room();
        if let Some(part) = parts.last_mut()
            && next <= PAGE_BYTES
            && room < PAGE_BYTES
            && lengthen(part, row_start, room)
        {
            self.length += room;
        }
    }
}

/// The longest row of this table: its numbers with all their digits.
fn longest_like(row: &[u8]) -> usize {
    row.split(|byte| *byte == b',').map(|field| (field.len() + 1).max(MAX_NUMBER_BYTES)).sum()
}

/// Adds zeros after the digits of the number that a row begins with; whether it begins with one.
fn lengthen(part: &mut Vec<u8>, row_start: usize, count: usize) -> bool {
    let Some(row) = part.get(row_start..) else { return false };
    let Some(end) = row.iter().position(|byte| matches!(byte, b',' | b'e')) else { return false };
    let digits = row.get(..end).unwrap_or_default();
    if digits.is_empty() || !digits.iter().all(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'-')) {
        return false;
    }
    let point = !digits.contains(&b'.');
    let zeros = (0..count).map(|k| if k == 0 && point { b'.' } else { b'0' });
    let at = row_start + end;
    part.splice(at..at, zeros);
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_row_lies_on_two_pages_and_no_number_changes(
            batches in prop::collection::vec(prop::collection::vec(prop::array::uniform5(any::<f64>()), 0..60), 1..30)
        ) {
            let mut pages = Pages::default();
            let mut file: Vec<u8> = Vec::new();
            let mut plain = String::new();
            let header = b"time_s,cable,a,b,c,d\n";
            for (k, batch) in batches.iter().enumerate() {
                let mut rows = if k == 0 { header.to_vec() } else { Vec::new() };
                for [t, a, b, c, d] in batch.iter().filter(|row| row.iter().all(|v| v.is_finite())) {
                    let row = format!("{t:?},\"a, b\",{a:?},{b:?},{c:?},{d:?}\n");
                    plain.push_str(&row);
                    rows.extend_from_slice(row.as_bytes());
                }
                for part in pages.lay_out(&rows) {
                    prop_assert!(file.len() / PAGE_BYTES == (file.len() + part.len() - 1) / PAGE_BYTES, "a part lies on two pages");
                    file.extend_from_slice(&part);
                    prop_assert_eq!(file.last(), Some(&b'\n'));
                }
            }
            let text = String::from_utf8(file).unwrap();
            let rows: Vec<&str> = text.lines().skip(1).collect();
            prop_assert_eq!(rows.len(), plain.lines().count());
            for (row, plain) in rows.iter().zip(plain.lines()) {
                let ((t, rest), (time, others)) = (row.split_once(',').unwrap(), plain.split_once(',').unwrap());
                prop_assert_eq!(rest, others);
                prop_assert_eq!(t.parse::<f64>().unwrap().to_bits(), time.parse::<f64>().unwrap().to_bits());
            }
            prop_assert!(text.len() < 2 * plain.len() + 2 * PAGE_BYTES);
        }
    }
}

//! The parts of a frame that differ from the frame before, in tiles of the screen.

use egui::Rect;

/// Side of a tile, pixels: that of a tile of Mesa's software rasteriser, which fills a whole one
/// fastest. Smaller: more rectangles are drawn one by one; larger: more is drawn that has not
/// changed.
pub const TILE_PIXELS: u32 = 64;

/// Most rectangles into which what has changed is divided. More: each is handed to the driver with
/// the pieces of the frame that lie in it; fewer: tiles between them are drawn too.
const MAX_RECTANGLES: usize = 12;

/// A rectangle of tiles: first and last column, first and last row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRectangle {
    /// First and last column.
    pub columns: [u16; 2],
    /// First and last row.
    pub rows: [u16; 2],
}

impl TileRectangle {
    /// Returns whether both have a tile in common.
    #[must_use]
    pub fn meets(self, other: Self) -> bool {
        let overlap = |a: [u16; 2], b: [u16; 2]| a[0] <= b[1] && b[0] <= a[1];
        overlap(self.columns, other.columns) && overlap(self.rows, other.rows)
    }

    /// Left edge, upper edge, width and height in pixels of a target of this size.
    #[must_use]
    pub fn pixels(self, [width, height]: [u32; 2]) -> [u32; 4] {
        let part = |[first, last]: [u16; 2], most: u32| {
            let from = (u32::from(first) * TILE_PIXELS).min(most);
            (from, ((u32::from(last) + 1) * TILE_PIXELS).min(most) - from)
        };
        let ((x, w), (y, h)) = (part(self.columns, width), part(self.rows, height));
        [x, y, w, h]
    }

    /// Number of tiles.
    fn count(self) -> u32 {
        let size = |[first, last]: [u16; 2]| u32::from(last - first) + 1;
        size(self.columns) * size(self.rows)
    }

    fn union(self, other: Self) -> Self {
        let both = |a: [u16; 2], b: [u16; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self { columns: both(self.columns, other.columns), rows: both(self.rows, other.rows) }
    }
}

/// The contents of each tile of a frame as a hash of all that is drawn there, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct TileContents {
    columns: u16,
    rows: u16,
    tiles_per_point: f32,
    hashes: Vec<u64>,
}

/// The hash of a sequence with another word at its end.
#[must_use]
pub fn hash_with(hash: u64, word: u64) -> u64 {
    // The golden ratio spreads each bit over the whole word.
    (hash.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

impl TileContents {
    /// Empty tiles of a screen.
    #[must_use]
    pub fn empty(screen: Rect, pixels_per_point: f32) -> Self {
        let count = |points: f32| (points * pixels_per_point / TILE_PIXELS as f32).ceil().max(1.0) as u16;
        let (columns, rows) = (count(screen.width()), count(screen.height()));
        let hashes = vec![0; usize::from(columns) * usize::from(rows)];
        Self { columns, rows, tiles_per_point: pixels_per_point / TILE_PIXELS as f32, hashes }
    }

    /// The tiles of a part of the screen, points; None where it lies beside it.
    #[must_use]
    pub fn covering(&self, part: Rect) -> Option<TileRectangle> {
        let range = |from: f32, to: f32, count: u16| {
            let [from, to] = [from, to].map(|v| v * self.tiles_per_point);
            // A value that is not a number lies nowhere. A cast rounds towards zero, and saturates.
            let within = from <= to && to >= 0.0 && from < f32::from(count);
            within.then(|| [from as u16, (to as u16).min(count - 1)])
        };
        let columns = range(part.min.x, part.max.x, self.columns)?;
        Some(TileRectangle { columns, rows: range(part.min.y, part.max.y, self.rows)? })
    }

    /// Notes that something is drawn over what these tiles have already.
    pub fn add(&mut self, tiles: TileRectangle, content: u64) {
        let [first, last] = tiles.columns.map(usize::from);
        for row in tiles.rows[0]..=tiles.rows[1] {
            let start = usize::from(row) * usize::from(self.columns);
            for hash in self.hashes.get_mut(start + first..=start + last).into_iter().flatten() {
                *hash = hash_with(*hash, content);
            }
        }
    }

    /// All tiles.
    #[must_use]
    pub fn all(&self) -> Vec<TileRectangle> {
        vec![TileRectangle { columns: [0, self.columns - 1], rows: [0, self.rows - 1] }]
    }

    /// Rectangles of tiles that hold every tile whose contents are others than before; all where
    /// the screen has another size.
    #[must_use]
    pub fn changed_since(&self, before: &Self) -> Vec<TileRectangle> {
        if (self.columns, self.rows, self.tiles_per_point) != (before.columns, before.rows, before.tiles_per_point) {
            return self.all();
        }
        let columns = usize::from(self.columns);
        let mut found: Vec<TileRectangle> = Vec::new();
        for (row, (now, then)) in self.hashes.chunks(columns).zip(before.hashes.chunks(columns)).enumerate() {
            let row = row as u16;
            let changed: Vec<bool> = now.iter().zip(then).map(|(a, b)| a != b).collect();
            let mut first = 0;
            for run in changed.chunk_by(|a, b| a == b) {
                let last = first + run.len() - 1;
                if run.first() == Some(&true) {
                    let columns = [first as u16, last as u16];
                    // A run below one of the same width belongs to it.
                    match found.iter_mut().find(|r| r.columns == columns && r.rows[1] + 1 == row) {
                        Some(above) => above.rows[1] = row,
                        None => found.push(TileRectangle { columns, rows: [row, row] }),
                    }
                }
                first = last + 1;
            }
        }
        while found.len() > MAX_RECTANGLES {
            join_nearest(&mut found);
        }
        found
    }
}

/// Joins the two rectangles that have the fewest other tiles in a rectangle round both.
fn join_nearest(rectangles: &mut Vec<TileRectangle>) {
    let mut best: Option<(i64, usize, usize)> = None;
    for (k, a) in rectangles.iter().enumerate() {
        for (l, b) in rectangles.iter().enumerate().skip(k + 1) {
            let added = i64::from(a.union(*b).count()) - i64::from(a.count()) - i64::from(b.count());
            if best.is_none_or(|(least, ..)| added < least) {
                best = Some((added, k, l));
            }
        }
    }
    if let Some((_, k, l)) = best {
        let other = rectangles.swap_remove(l);
        if let Some(one) = rectangles.get_mut(k) {
            *one = one.union(other);
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    fn rect(x0: f32, y0: f32, x1: f32, y1: f32) -> Rect {
        Rect::from_min_max(pos2(x0, y0), pos2(x1, y1))
    }

    fn screen() -> TileContents {
        TileContents::empty(rect(0.0, 0.0, 1280.0, 800.0), 1.0)
    }

    #[test]
    fn tiles_cover_a_part_of_the_screen() {
        let tiles = screen();
        assert_eq!((tiles.columns, tiles.rows), (20, 13));
        let all = TileRectangle { columns: [0, 19], rows: [0, 12] };
        assert_eq!(tiles.covering(rect(-9.0, -9.0, 9000.0, 9000.0)), Some(all));
        let one = TileRectangle { columns: [1, 1], rows: [2, 2] };
        assert_eq!(tiles.covering(rect(64.0, 130.0, 127.0, 191.0)), Some(one));
        assert_eq!(one.pixels([1280, 800]), [64, 128, 64, 64]);
        assert_eq!(all.pixels([1280, 800]), [0, 0, 1280, 800]);
        for beside in [rect(1300.0, 0.0, 1400.0, 9.0), rect(-9.0, -9.0, -1.0, -1.0), Rect::NOTHING, Rect::NAN] {
            assert_eq!(tiles.covering(beside), None, "{beside:?}");
        }
        let scaled = TileContents::empty(rect(0.0, 0.0, 1280.0, 800.0), 1.5);
        assert_eq!((scaled.columns, scaled.rows), (30, 19));
    }

    /// Every tile that differs is in a rectangle, however many there are.
    #[test]
    fn every_changed_tile_is_found() {
        let mut seed = 7_u64;
        for changes in [0, 1, 3, 30, 200] {
            let (before, mut now) = (screen(), screen());
            for _ in 0..changes {
                seed = hash_with(seed, 3);
                let (x, y) = ((seed >> 20) % 20, (seed >> 40) % 13);
                let tile = TileRectangle { columns: [x as u16; 2], rows: [y as u16; 2] };
                now.add(tile, seed);
            }
            let found = now.changed_since(&before);
            assert!(found.len() <= MAX_RECTANGLES);
            for (k, (a, b)) in now.hashes.iter().zip(&before.hashes).enumerate() {
                let tile = TileRectangle { columns: [(k % 20) as u16; 2], rows: [(k / 20) as u16; 2] };
                assert!(a == b || found.iter().any(|r| r.meets(tile)), "{tile:?} of {changes}");
            }
        }
        let (before, mut now) = (screen(), screen());
        let block = TileRectangle { columns: [3, 5], rows: [2, 9] };
        now.add(block, 1);
        assert_eq!(now.changed_since(&before), [block]);
    }

    /// The order in which things lie over each other decides a pixel.
    #[test]
    fn the_order_of_what_is_drawn_counts() {
        let tile = TileRectangle { columns: [0, 0], rows: [0, 0] };
        let [mut a, mut b] = [screen(), screen()];
        a.add(tile, 1);
        a.add(tile, 2);
        b.add(tile, 2);
        b.add(tile, 1);
        assert_eq!(a.changed_since(&b), [tile]);
        assert_eq!(a.changed_since(&TileContents::empty(rect(0.0, 0.0, 640.0, 480.0), 1.0)), a.all());
    }
}

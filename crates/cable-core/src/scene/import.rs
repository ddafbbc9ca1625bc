//! An import turns tables of x and y, and SVG paths, into lines for terrain and beams.
//!
//! A table has two numbers a line, between them a tab, a semicolon, a comma or spaces. Where
//! something else stands between them a comma is a decimal mark: `1,5;2,25`. Lines without numbers
//! before the first point are headings.

use crate::math::Point;

/// Most points of an import: as many as a scene may have.
const MAX_POINTS: usize = 1_000_000;
/// Points nearer than this to the one before are one, m: ten thousand times finer than any survey.
const POINT_TOLERANCE_M: f64 = 1e-6;
/// Straight pieces a curve of an SVG path is drawn with: a quarter circle of 1 m is then off by 0.3
/// mm.
const CURVE_PIECES: u32 = 16;

/// A line that was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Its points, m.
    pub points_m: Vec<Point>,
    /// It is the edge of something solid, not the top of the ground.
    pub closed: bool,
}

/// The lines that were read, and the changes that the import made to them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Import {
    /// The lines, those of the ground from left to right.
    pub lines: Vec<Line>,
    /// The changes.
    pub changes: Vec<ImportChange>,
}

/// A change that an import makes to what it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImportChange {
    /// Heading lines of a table are left out.
    HeadingsLeftOut {
        /// Their number.
        count: usize,
    },
    /// Points in the place of the one before are left out.
    PointsMerged {
        /// Their number.
        count: usize,
    },
    /// Ground that ran to the left is turned, since it is solid below.
    GroundTurned,
    /// Transforms of an SVG are left out.
    TransformsLeftOut,
    /// The y axis of an SVG, which points downwards, is turned upwards.
    AxisTurned,
}

/// The reason why a text is not imported.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImportFault {
    /// The unit has no length.
    Unit,
    /// There is no line in it.
    NoLine,
    /// It has more points than a scene may have.
    TooManyPoints {
        /// The most that there may be.
        most: usize,
    },
    /// A row of a table is not two numbers.
    Row {
        /// Line, from 1.
        line: usize,
        /// Its beginning.
        text: String,
    },
    /// A line has too few points.
    TooFewPoints {
        /// Their number.
        count: usize,
        /// The number it needs.
        least: usize,
    },
    /// A number of a list is not finite.
    Number {
        /// Its beginning.
        text: String,
    },
    /// An attribute is not a list of numbers.
    List {
        /// Its beginning.
        text: String,
    },
    /// A command of a path that is not read.
    PathCommand {
        /// The command.
        command: char,
    },
}

/// Reads a table or an SVG; `metres_per_unit` is the length of its unit.
///
/// # Errors An error names the part that cannot be read, with its line.
pub fn read(text: &str, metres_per_unit: f64) -> Result<Import, ImportFault> {
    if !(metres_per_unit > 0.0 && metres_per_unit.is_finite()) {
        return Err(ImportFault::Unit);
    }
    let text = text.trim_start_matches('\u{feff}');
    let mut import = Import::default();
    if text.trim_start().starts_with('<') {
        svg(text, &mut import)?;
    } else {
        table(text, &mut import)?;
    }
    for line in &mut import.lines {
        tidy(line, metres_per_unit, &mut import.changes)?;
    }
    if import.lines.is_empty() {
        return Err(ImportFault::NoLine);
    }
    Ok(import)
}

/// Reads a table with two numbers a row as one line.
fn table(text: &str, import: &mut Import) -> Result<(), ImportFault> {
    let mut line = Line::default();
    let mut headings = 0;
    for (k, row) in text.lines().enumerate() {
        let row = row.trim();
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        match pair(row) {
            Some(p) if line.points_m.len() < MAX_POINTS => line.points_m.push(p),
            Some(_) => return Err(ImportFault::TooManyPoints { most: MAX_POINTS }),
            None if line.points_m.is_empty() => headings += 1,
            None => return Err(ImportFault::Row { line: k + 1, text: short(row) }),
        }
    }
    if headings > 0 {
        import.changes.push(ImportChange::HeadingsLeftOut { count: headings });
    }
    if !line.points_m.is_empty() {
        import.lines.push(line);
    }
    Ok(())
}

fn short(text: &str) -> String {
    text.chars().take(40).collect()
}

/// The character before the decimals of a number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DecimalMark {
    Comma,
    Point,
}

/// Two numbers of a row.
fn pair(row: &str) -> Option<Point> {
    let by = |separator: char, mark: DecimalMark| -> Option<Point> {
        let mut fields = row.split(separator).map(str::trim).filter(|f| !f.is_empty());
        let mut next = || {
            let field = fields.next()?;
            let text = if mark == DecimalMark::Comma { field.replacen(',', ".", 1) } else { field.to_owned() };
            text.parse::<f64>().ok().filter(|v| v.is_finite())
        };
        let p = [next()?, next()?];
        // More columns are somebody else's table: which two are meant is a guess.
        fields.next().is_none().then_some(p)
    };
    for separator in ['\t', ';'] {
        if row.contains(separator) {
            return by(separator, DecimalMark::Comma);
        }
    }
    if row.contains(' ') && !row.contains(", ") {
        return by(' ', DecimalMark::Comma);
    }
    by(',', DecimalMark::Point)
}

/// Scales, merges points that are one, and turns ground that runs to the left.
fn tidy(line: &mut Line, metres_per_unit: f64, changes: &mut Vec<ImportChange>) -> Result<(), ImportFault> {
    let before = line.points_m.len();
    for p in &mut line.points_m {
        *p = p.map(|v| v * metres_per_unit);
    }
    line.points_m.dedup_by(|b, a| (b[0] - a[0]).hypot(b[1] - a[1]) < POINT_TOLERANCE_M);
    if let (true, [first, .., last]) = (line.closed, line.points_m.as_slice())
        && (first[0] - last[0]).hypot(first[1] - last[1]) < POINT_TOLERANCE_M
    {
        line.points_m.pop();
    }
    let merged = before - line.points_m.len();
    if merged > 0 {
        changes.push(ImportChange::PointsMerged { count: merged });
    }
    let least = if line.closed { 3 } else { 2 };
    if line.points_m.len() < least {
        return Err(ImportFault::TooFewPoints { count: line.points_m.len(), least });
    }
    if let (false, [first, .., last]) = (line.closed, line.points_m.as_slice())
        && last[0] < first[0]
    {
        line.points_m.reverse();
        changes.push(ImportChange::GroundTurned);
    }
    Ok(())
}

/// Values of an attribute of all elements of a name.
fn attributes<'a>(text: &'a str, element: &str, attribute: &str) -> Vec<&'a str> {
    let mut found = Vec::new();
    for part in text.split('<').skip(1) {
        let Some(rest) = part.strip_prefix(element) else { continue };
        let (Some(end), true) = (rest.find('>'), rest.starts_with(char::is_whitespace)) else { continue };
        let inside = &rest[..end];
        for quote in ['"', '\''] {
            let key = format!(" {attribute}={quote}");
            let flat = inside.replace(['\n', '\t', '\r'], " ");
            if let Some(at) = flat.find(&key) {
                // Replaced characters are one byte each, so places are the same in both.
                let value = &inside[at + key.len()..];
                found.extend(value.find(quote).map(|end| &value[..end]));
            }
        }
    }
    found
}

/// Reads the lines, polygons and paths of an SVG drawing; its y axis points down.
fn svg(text: &str, import: &mut Import) -> Result<(), ImportFault> {
    if text.contains(" transform=") {
        import.changes.push(ImportChange::TransformsLeftOut);
    }
    for (element, closed) in [("polyline", false), ("polygon", true)] {
        for points in attributes(text, element, "points") {
            let numbers = numbers(points)?;
            let points_m = numbers.chunks_exact(2).map(|p| [p[0], -p[1]]).collect();
            import.lines.push(Line { points_m, closed });
        }
    }
    for d in attributes(text, "path", "d") {
        path(d, &mut import.lines)?;
    }
    if import.lines.iter().map(|l| l.points_m.len()).sum::<usize>() > MAX_POINTS {
        return Err(ImportFault::TooManyPoints { most: MAX_POINTS });
    }
    import.changes.push(ImportChange::AxisTurned);
    Ok(())
}

/// The numbers of a list, with or without commas.
fn numbers(text: &str) -> Result<Vec<f64>, ImportFault> {
    let mut out = Vec::new();
    let mut start = None;
    let bytes = text.as_bytes();
    let mut take = |from: usize, to: usize| -> Result<(), ImportFault> {
        let word = text.get(from..to).unwrap_or_default();
        match word.parse::<f64>() {
            Ok(v) if v.is_finite() => out.push(v),
            _ => return Err(ImportFault::Number { text: short(word) }),
        }
        Ok(())
    };
    for (k, &b) in bytes.iter().enumerate() {
        let exponent = k > 0 && matches!(bytes.get(k - 1), Some(b'e' | b'E'));
        let sign = matches!(b, b'-' | b'+') && !exponent;
        let part = b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E') || (matches!(b, b'-' | b'+') && exponent);
        if let (Some(from), true) = (start, !part) {
            take(from, k)?;
            start = None;
        }
        if start.is_none() && (part || sign) {
            start = Some(k);
        } else if !part && !sign && !matches!(b, b' ' | b',' | b'\n' | b'\t' | b'\r') {
            return Err(ImportFault::List { text: short(text) });
        }
    }
    if let Some(from) = start {
        take(from, bytes.len())?;
    }
    Ok(out)
}

/// The subpaths of the data of a path (SVG 1.1, chapter 8.3), y upwards.
fn path(d: &str, lines: &mut Vec<Line>) -> Result<(), ImportFault> {
    let mut at = [0.0; 2];
    let mut line = Line::default();
    let mut rest = d.trim();
    while let Some(command) = rest.chars().next() {
        let body = rest.get(command.len_utf8()..).unwrap_or_default();
        let end = body.find(|c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E')).unwrap_or(body.len());
        let values = numbers(&body[..end])?;
        rest = body[end..].trim_start();
        let relative = command.is_ascii_lowercase();
        let place =
            |at: Point, p: &[f64]| -> Point { if relative { [at[0] + p[0], at[1] + p[1]] } else { [p[0], p[1]] } };
        match command.to_ascii_uppercase() {
            'M' => {
                finish(&mut line, lines);
                for p in values.chunks_exact(2) {
                    at = place(at, p);
                    line.points_m.push([at[0], -at[1]]);
                }
            }
            'L' => {
                for p in values.chunks_exact(2) {
                    at = place(at, p);
                    line.points_m.push([at[0], -at[1]]);
                }
            }
            'H' | 'V' => {
                let axis = usize::from(command.eq_ignore_ascii_case(&'v'));
                for v in values {
                    at[axis] = if relative { at[axis] + v } else { v };
                    line.points_m.push([at[0], -at[1]]);
                }
            }
            'C' | 'Q' => {
                let count = if command.eq_ignore_ascii_case(&'c') { 6 } else { 4 };
                for p in values.chunks_exact(count) {
                    let corners: Vec<Point> = p.chunks_exact(2).map(|p| place(at, p)).collect();
                    at = curve(at, &corners, &mut line.points_m);
                }
            }
            'Z' => {
                line.closed = true;
                at = line.points_m.first().map_or(at, |p| [p[0], -p[1]]);
                finish(&mut line, lines);
            }
            other => {
                return Err(ImportFault::PathCommand { command: other });
            }
        }
    }
    finish(&mut line, lines);
    Ok(())
}

fn finish(line: &mut Line, lines: &mut Vec<Line>) {
    if line.points_m.len() > 1 {
        lines.push(std::mem::take(line));
    } else {
        *line = Line::default();
    }
}

/// A Bézier curve of degree 2 or 3 as straight pieces, by de Casteljau's construction; its end.
fn curve(start: Point, corners: &[Point], out: &mut Vec<Point>) -> Point {
    let mut end = start;
    for k in 1..=CURVE_PIECES {
        let t = f64::from(k) / f64::from(CURVE_PIECES);
        let mut level: Vec<Point> = std::iter::once(start).chain(corners.iter().copied()).collect();
        while level.len() > 1 {
            level = level
                .windows(2)
                .map(|w| [w[0][0] + (w[1][0] - w[0][0]) * t, w[0][1] + (w[1][1] - w[0][1]) * t])
                .collect();
        }
        end = level.first().copied().unwrap_or(end);
        out.push([end[0], -end[1]]);
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(text: &str) -> Vec<Point> {
        read(text, 1.0).unwrap().lines.remove(0).points_m
    }

    #[test]
    fn every_separator_and_decimal_mark_is_read() {
        let expected = vec![[-1.5, 2.25], [0.0, 1.0], [3.0, 1e-3]];
        for text in [
            "-1.5,2.25\n0,1\n3,0.001",
            "-1.5, 2.25\n0, 1\n3, 1e-3\n",
            "x;y\n-1,5;2,25\n0;1\n3;0,001",
            "x\ty\n-1,5\t2,25\n\n0\t1\n# end\n3\t0.001",
            "\u{feff}-1,5 2,25\r\n0  1\r\n3 0.001",
        ] {
            assert_eq!(points(text), expected, "{text:?}");
        }
    }

    #[test]
    fn what_is_done_to_it_is_reported() {
        let import = read("x,y\n3,1\n2,1\n2,1\n0,0\n", 0.5).unwrap();
        assert_eq!(import.lines[0].points_m, [[0.0, 0.0], [1.0, 0.5], [1.5, 0.5]]);
        let (headings, points) = (ImportChange::HeadingsLeftOut { count: 1 }, ImportChange::PointsMerged { count: 1 });
        assert_eq!(import.changes, [headings, points, ImportChange::GroundTurned]);
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_its_line() {
        for (text, part) in [
            ("0,0\n1,NaN\n", "line 2"),
            ("0,0\n1,2,3\n", "line 2"),
            ("1,5,2,5\n", "no line"),
            ("", "no line"),
            ("0,0\n", "1 point"),
            ("<svg><path d=\"M0 0 A 1 1 0 0 0 2 2\"/></svg>", "`A`"),
            ("<svg><path d=\"M0 0 L 1e999 2\"/></svg>", "finite"),
        ] {
            let error = read(text, 1.0).unwrap_err().to_string();
            assert!(error.contains(part), "{text:?}: {error}");
        }
        assert!(read("0,0\n1,1", 0.0).is_err() && read("0,0\n1,1", f64::NAN).is_err());
    }

    #[test]
    fn svg_paths_become_ground_and_beams() {
        let text = "<svg><path id='a' d='M 0,0 h2 l1-1 V-3'/>\n<polygon\n points=\"0,0 1,0 1,-1\"/>\
                    <path d=\"m1 1 2 0 0 2z\"/><path d=\"M0 0Q1-2 2 0\"/></svg>";
        let lines = read(text, 1.0).unwrap().lines;
        assert_eq!(lines[0], Line { points_m: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], closed: true });
        assert_eq!(lines[1].points_m, [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [3.0, 3.0]]);
        assert_eq!(lines[2], Line { points_m: vec![[1.0, -1.0], [3.0, -1.0], [3.0, -3.0]], closed: true });
        // The top of the parabola.
        assert_eq!(lines[3].points_m.len(), 17);
        assert!((lines[3].points_m[8][1] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_hundred_thousand_points_are_read() {
        let text: String = (0..100_000).map(|k| format!("{};{}\n", k, k % 7)).collect();
        assert_eq!(points(&text).len(), 100_000);
    }

    proptest! {
        #[test]
        fn nothing_panics(text in "\\PC{0,80}", svg in "[MLHVCQZmlhvcqz0-9eE+., -]{0,60}") {
            let _ = read(&text, 1.0);
            let _ = read(&format!("<svg><path d=\"{svg}\"/></svg>"), 1.0);
        }
    }
}

//! Points of a terrain or beam from a table of x and y, such as a survey or a scan.

use super::file::{MAX_TEXT_BYTES, position};
use super::path::Path;
use super::range;
use crate::error::{SceneError, SceneFault};
use crate::math::Point;

/// Reads points, one a line: x and y in metres, parted by comma, semicolon, tab or space; a first line without
/// numbers is a heading, `#` begins a comment. A point in the place of the one before it is left out.
///
/// # Errors
/// What is wrong, with line and column.
pub fn points_from_table(text: &str) -> Result<Vec<Point>, SceneError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.len() > MAX_TEXT_BYTES {
        return Err(Path::Root.shape(format!("{} bytes are more than the {MAX_TEXT_BYTES} allowed", text.len())));
    }
    let mut points: Vec<Point> = Vec::new();
    let mut heading_may_follow = true;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let here = start;
        start += line.len();
        let content = line.split('#').next().unwrap_or_default();
        let words = || content.split([',', ';', '\t', ' ', '\r', '\n']).filter(|w| !w.is_empty());
        if words().next().is_none() {
            continue;
        }
        if std::mem::take(&mut heading_may_follow) && words().all(|w| w.parse::<f64>().is_err()) {
            continue;
        }
        let refuse = |fault| SceneError { path: String::new(), fault, at: Some(position(text, here)) };
        let mut point = [0.0; 2];
        let mut count = 0;
        for word in words() {
            let Ok(value) = word.parse::<f64>() else {
                let word: String = word.chars().take(40).collect();
                return Err(refuse(SceneFault::Syntax { message: format!("`{word}` is not a number") }));
            };
            if !range::COORDINATE.holds(value) {
                return Err(refuse(SceneFault::Range { value, allowed: range::COORDINATE.text }));
            }
            if let Some(slot) = point.get_mut(count) {
                *slot = value;
            }
            count += 1;
        }
        if count != 2 {
            return Err(refuse(SceneFault::Syntax { message: format!("{count} numbers where x and y are needed") }));
        }
        if points.last() != Some(&point) {
            points.push(point);
        }
    }
    if points.len() < 2 {
        return Err(Path::Root.shape(format!("{} points where at least 2 are needed", points.len())));
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_many_makes_are_read() {
        let want = vec![[0.0, 1.5], [1.0, -0.25], [2e1, 3.0]];
        for text in [
            "x_m,y_m\n0,1.5\n1,-0.25\n20,3\n",
            "0;1.5\r\n1;-0.25\r\n1;-0.25\r\n\r\n2e1;3",
            "\u{feff}# survey\nx\ty\n0\t1.5 # here\n1\t-0.25\n20\t3\n",
            "  0   1.5\n  1  -0.25\n 20   3",
        ] {
            assert_eq!(points_from_table(text).unwrap(), want, "{text:?}");
        }
    }

    #[test]
    fn what_is_no_point_is_refused_with_its_line() {
        let cases = [
            ("0,1\n2\n", "line 2, column 1: 1 numbers"),
            ("0,1\n2,3,4\n", "line 2, column 1: 3 numbers"),
            ("0,1\nx,y\n", "line 2, column 1: `x` is not"),
            ("x,y\nx,y\n0,1\n", "line 2"),
            ("0,1\n\n2,nan\n", "line 3"),
            ("0,1\n2,1e9\n", "-1e7 to 1e7 m"),
            ("0,1\n0,1\n", "1 points"),
            ("", "0 points"),
        ];
        for (text, say) in cases {
            let error = points_from_table(text).unwrap_err().to_string();
            assert!(error.contains(say), "{text:?}: {error}");
        }
    }
}

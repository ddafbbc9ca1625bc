//! A dot plot is written as SVG text: one line a scene, error on the left, cost on the right, a
//! mark a model.

use std::fmt::Write;

/// A value of one model on one line.
#[derive(Clone, Copy, Debug)]
pub struct Dot {
    /// The value, > 0; smaller than the axis shows is drawn at its edge.
    pub value: f64,
    /// Fill, from the palette of M. Okabe and K. Ito (2008).
    pub colour: &'static str,
    /// 0 a disc, 3 a triangle, else a square.
    pub corners: u32,
}

/// One line of the plot.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its subject.
    pub name: String,
    /// Small print beside it.
    pub note: String,
    /// Up to here (same unit as the dots) a value of the left column says nothing: drawn as a grey
    /// bar.
    pub blind_to: f64,
    /// Left and right column.
    pub dots: [Vec<Dot>; 2],
}

/// The whole plot.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Above everything.
    pub title: String,
    /// Name and colour and corners of each mark.
    pub legend: Vec<(String, &'static str, u32)>,
    /// Label and decades of each column.
    pub columns: [(&'static str, (i32, i32)); 2],
    /// The lines.
    pub lines: Vec<Line>,
}

/// Room for the longest note: 45 letters of 10 points.
const NAMES: f64 = 300.0;
const COLUMN: f64 = 360.0;
const GAP: f64 = 60.0;
const ROW: f64 = 34.0;
const TOP: f64 = 92.0;
const BOTTOM: f64 = 56.0;

fn mark(out: &mut String, (x, y): (f64, f64), colour: &str, corners: u32) {
    let _ = match corners {
        0 => writeln!(out, r#"<circle cx="{x:.1}" cy="{y:.1}" r="6" fill="{colour}"/>"#),
        3 => writeln!(
            out,
            r#"<polygon points="{x:.1},{:.1} {:.1},{:.1} {:.1},{:.1}" fill="{colour}"/>"#,
            y - 7.0,
            x - 6.5,
            y + 5.0,
            x + 6.5,
            y + 5.0
        ),
        _ => writeln!(out, r#"<rect x="{:.1}" y="{:.1}" width="11" height="11" fill="{colour}"/>"#, x - 5.5, y - 5.5),
    };
}

/// Draws it.
#[must_use]
pub fn svg(plot: &Plot) -> String {
    let (w, bottom) = (NAMES + 2.0 * COLUMN + GAP + 30.0, TOP + ROW * plot.lines.len() as f64);
    let h = bottom + BOTTOM;
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" font-family="sans-serif" font-size="13" fill="#222">
<rect width="{w}" height="{h}" fill="#fff"/>
<text x="16" y="26" font-size="16" font-weight="bold">{}</text>
"##,
        plot.title
    );
    let mut x = 22.0;
    for (name, colour, corners) in &plot.legend {
        mark(&mut out, (x, 50.0), colour, *corners);
        let _ = writeln!(out, r#"<text x="{}" y="54">{name}</text>"#, x + 12.0);
        x += 40.0 + 7.5 * name.len() as f64;
    }
    let _ = writeln!(
        out,
        r##"<rect x="{x}" y="44" width="34" height="12" fill="#ddd"/><text x="{}" y="54">finer than the reference knows</text>"##,
        x + 42.0
    );
    for (k, line) in plot.lines.iter().enumerate() {
        let y = TOP + ROW * (k as f64 + 0.5);
        if k % 2 == 0 {
            let _ =
                writeln!(out, r##"<rect x="0" y="{:.1}" width="{w}" height="{ROW}" fill="#f6f6f6"/>"##, y - 0.5 * ROW);
        }
        let _ = writeln!(out, r#"<text x="16" y="{:.1}" font-weight="bold">{}</text>"#, y - 1.0, line.name);
        let _ = writeln!(out, r##"<text x="16" y="{:.1}" font-size="10" fill="#666">{}</text>"##, y + 11.0, line.note);
    }
    for (c, (label, (a, b))) in plot.columns.iter().enumerate() {
        let left = NAMES + (COLUMN + GAP) * c as f64;
        let place = |v: f64| left + COLUMN * ((v.log10() - f64::from(*a)) / f64::from(b - a)).clamp(0.0, 1.0);
        for n in (*a..=*b).filter(|n| b - a <= 8 || (n - a) % 2 == 0) {
            let at = place(10f64.powi(n));
            let power = n.to_string().replace('-', "−");
            let _ = writeln!(
                out,
                r##"<line x1="{at:.1}" y1="{TOP}" x2="{at:.1}" y2="{bottom}" stroke="#ccc"/><text x="{at:.1}" y="{}" text-anchor="middle">10<tspan dy="-5" font-size="9">{power}</tspan></text>"##,
                bottom + 18.0
            );
        }
        let _ = writeln!(
            out,
            r#"<text x="{}" y="{}" text-anchor="middle">{label}</text>"#,
            left + 0.5 * COLUMN,
            bottom + 42.0
        );
        for (k, line) in plot.lines.iter().enumerate() {
            let y = TOP + ROW * (k as f64 + 0.5);
            if c == 0 && line.blind_to > 0.0 {
                let _ = writeln!(
                    out,
                    r##"<rect x="{left}" y="{:.1}" width="{:.1}" height="12" fill="#ddd"/>"##,
                    y - 6.0,
                    place(line.blind_to) - left
                );
            }
            for dot in &line.dots[c] {
                mark(&mut out, (place(dot.value), y), dot.colour, dot.corners);
            }
        }
    }
    out.push_str("</svg>\n");
    out
}

//! Log–log charts are written as SVG text. Four fixed panels need axes, marks and a legend and
//! nothing else, which is less code than a plotting library's set-up and no dependency.

use std::fmt::Write;

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend; empty: it is not in the legend.
    pub name: String,
    /// Stroke and fill, from the palette of M. Okabe and K. Ito (2008), told apart with any colour
    /// vision.
    pub colour: &'static str,
    /// Corners of its mark: 0 a disc, 3, 4 … a polygon, so that colour is not needed either.
    pub corners: u32,
    /// True if a line joins its points.
    pub joined: bool,
    /// x, y, both > 0.
    pub points: Vec<(f64, f64)>,
}

/// One pair of axes.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Above it.
    pub title: String,
    /// Quantity and unit.
    pub x_label: &'static str,
    /// Quantity and unit.
    pub y_label: &'static str,
    /// Decades shown.
    pub x_decades: (i32, i32),
    /// Decades shown.
    pub y_decades: (i32, i32),
    /// The layers that are drawn.
    pub series: Vec<Series>,
}

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 330.0;
const LEFT: f64 = 68.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 50.0;
const LEGEND: f64 = 34.0;

/// Panels in rows of `columns`, one legend on top.
#[must_use]
pub fn svg(panels: &[Panel], columns: usize) -> String {
    let rows = panels.len().div_ceil(columns);
    let (w, h) = (WIDTH * columns as f64, HEIGHT * rows as f64 + LEGEND);
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" font-family="sans-serif" font-size="12" fill="#222">
<rect width="{w}" height="{h}" fill="#fff"/>
"##
    );
    let mut x = LEFT;
    for s in panels.first().map_or(&[][..], |p| &p.series).iter().filter(|s| !s.name.is_empty()) {
        mark(&mut out, s, (x, LEGEND / 2.0));
        let _ = writeln!(out, r#"<text x="{}" y="{}">{}</text>"#, x + 10.0, LEGEND / 2.0 + 4.0, s.name);
        x += 30.0 + 6.5 * s.name.len() as f64;
    }
    for (k, p) in panels.iter().enumerate() {
        panel(&mut out, p, ((k % columns) as f64 * WIDTH, (k / columns) as f64 * HEIGHT + LEGEND));
    }
    out.push_str("</svg>\n");
    out
}

fn mark(out: &mut String, s: &Series, (x, y): (f64, f64)) {
    let colour = s.colour;
    if s.corners < 3 {
        let _ = writeln!(out, r#"<circle cx="{x:.2}" cy="{y:.2}" r="4.5" fill="{colour}"/>"#);
        return;
    }
    let corner = |k: u32| {
        let a = std::f64::consts::TAU * f64::from(k) / f64::from(s.corners) - std::f64::consts::FRAC_PI_2;
        format!("{:.2},{:.2}", x + 5.5 * a.cos(), y + 5.5 * a.sin())
    };
    let corners: Vec<String> = (0..s.corners).map(corner).collect();
    let _ = writeln!(out, r#"<polygon points="{}" fill="{colour}"/>"#, corners.join(" "));
}

/// 10ⁿ, as the axis writes it.
fn power(n: i32) -> String {
    format!(r#"10<tspan dy="-5" font-size="9">{}</tspan>"#, n.to_string().replace('-', "−"))
}

fn panel(out: &mut String, p: &Panel, (x0, y0): (f64, f64)) {
    let (w, h) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
    let place = |v: f64, (a, b): (i32, i32)| (v.log10() - f64::from(a)) / f64::from(b - a);
    let at = |(x, y): (f64, f64)| (x0 + LEFT + w * place(x, p.x_decades), y0 + TOP + h * (1.0 - place(y, p.y_decades)));
    let _ = writeln!(
        out,
        r#"<text x="{}" y="{}" font-size="13" font-weight="bold">{}</text>"#,
        x0 + LEFT,
        y0 + TOP - 10.0,
        p.title
    );
    let (right, bottom) = (x0 + LEFT + w, y0 + TOP + h);
    for n in p.x_decades.0..=p.x_decades.1 {
        let x = at((10f64.powi(n), 1.0)).0;
        let _ = writeln!(out, r##"<line x1="{x:.2}" y1="{}" x2="{x:.2}" y2="{bottom}" stroke="#ddd"/>"##, y0 + TOP);
        let _ = writeln!(out, r#"<text x="{x:.2}" y="{}" text-anchor="middle">{}</text>"#, bottom + 20.0, power(n));
    }
    for n in (p.y_decades.0..=p.y_decades.1).filter(|n| n % 2 == 0) {
        let y = at((1.0, 10f64.powi(n))).1;
        let _ = writeln!(out, r##"<line x1="{}" y1="{y:.2}" x2="{right}" y2="{y:.2}" stroke="#ddd"/>"##, x0 + LEFT);
        let _ =
            writeln!(out, r#"<text x="{}" y="{:.2}" text-anchor="end">{}</text>"#, x0 + LEFT - 6.0, y + 4.0, power(n));
    }
    let _ = writeln!(
        out,
        r##"<rect x="{}" y="{}" width="{w}" height="{h}" fill="none" stroke="#888"/>"##,
        x0 + LEFT,
        y0 + TOP
    );
    let _ = writeln!(
        out,
        r#"<text x="{}" y="{}" text-anchor="middle">{}</text>"#,
        x0 + LEFT + w / 2.0,
        bottom + 40.0,
        p.x_label
    );
    let (lx, ly) = (x0 + 16.0, y0 + TOP + h / 2.0);
    let _ = writeln!(
        out,
        r#"<text x="{lx}" y="{ly}" text-anchor="middle" transform="rotate(-90 {lx} {ly})">{}</text>"#,
        p.y_label
    );
    for s in &p.series {
        let points: Vec<(f64, f64)> = s.points.iter().map(|q| at(*q)).collect();
        let joined = if s.joined { &points[..] } else { &[] };
        let line: Vec<String> = joined.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
        let _ = writeln!(
            out,
            r#"<polyline points="{}" fill="none" stroke="{}" stroke-width="1.5"/>"#,
            line.join(" "),
            s.colour
        );
        for q in points {
            mark(out, s, q);
        }
    }
}

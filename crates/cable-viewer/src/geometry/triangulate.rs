//! A simple polygon is divided into triangles by ear clipping (G. H. Meisters, "Polygons have
//! ears", American Mathematical Monthly 82, 1975). A polygon that crosses itself gives what was
//! found so far.

use cable_core::math::Point;

/// Twice the signed area of a triangle, m².
fn area2(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// Corner indices of triangles that fill the polygon, either winding.
#[must_use]
pub fn triangulate(points: &[Point]) -> Vec<[u32; 3]> {
    let n = points.len();
    let mut left: Vec<usize> = (0..n).collect();
    let winding: f64 = (0..n).map(|i| area2([0.0; 2], points[i], points[(i + 1) % n])).sum();
    if winding < 0.0 {
        left.reverse();
    }
    let mut out = Vec::with_capacity(n.saturating_sub(2));
    while left.len() > 3 {
        let m = left.len();
        let ear = (0..m).find(|&i| {
            let [a, b, c] = [left[(i + m - 1) % m], left[i], left[(i + 1) % m]];
            let [pa, pb, pc] = [points[a], points[b], points[c]];
            area2(pa, pb, pc) >= 0.0
                && !left.iter().any(|&k| {
                    let p = points[k];
                    ![a, b, c].contains(&k)
                        && area2(pa, pb, p) > 0.0
                        && area2(pb, pc, p) > 0.0
                        && area2(pc, pa, p) > 0.0
                })
        });
        let Some(i) = ear else { return out };
        out.push([left[(i + m - 1) % m] as u32, left[i] as u32, left[(i + 1) % m] as u32]);
        left.remove(i);
    }
    if let [a, b, c] = left[..] {
        out.push([a as u32, b as u32, c as u32]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_of_a_concave_polygon_add_up_to_its_area() {
        let arrow = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 1.0], [0.0, 3.0]];
        let whole: f64 = (0..5).map(|i| area2([0.0; 2], arrow[i], arrow[(i + 1) % 5])).sum();
        for points in [arrow.to_vec(), arrow.iter().rev().copied().collect()] {
            let parts: Vec<f64> = triangulate(&points)
                .iter()
                .map(|t| area2(points[t[0] as usize], points[t[1] as usize], points[t[2] as usize]))
                .collect();
            assert_eq!(parts.len(), 3);
            assert!(parts.iter().all(|&a| a > 0.0));
            assert!((parts.iter().sum::<f64>() - whole.abs()).abs() < 1e-12);
        }
    }
}

//! Lines are cut at their sharp corners: the painter joins the two sides of a corner of 90° and
//! more by a slanted piece several times as thick as the line, which reads as a spike or a slope.

use egui::{Pos2, Vec2};

/// Least cosine of a turn that is joined. Smaller: the steps of tension at contacts are slanted;
/// larger: smooth lines fall into pieces.
const MIN_JOINED_COSINE: f32 = 0.5;
/// Most pieces of a line. More: a line that goes up and down in each column takes longer to draw,
/// and has no corners that are told apart.
const MAX_PIECES: usize = 64;

/// The points of a line in pieces that begin where the one before ends; `to_screen` is where a
/// point stands, points of the screen.
pub(super) fn pieces(points: &[[f64; 2]], to_screen: impl Fn([f64; 2]) -> Pos2) -> Vec<&[[f64; 2]]> {
    let mut pieces = Vec::new();
    let mut first = 0;
    let mut direction: Option<Vec2> = None;
    for k in 1..points.len() {
        let step = to_screen(points[k]) - to_screen(points[k - 1]);
        if step.length_sq() <= 0.0 || !step.is_finite() {
            continue;
        }
        let next = step.normalized();
        if direction.is_some_and(|before| before.dot(next) < MIN_JOINED_COSINE) {
            pieces.push(&points[first..k]);
            first = k - 1;
            if pieces.len() == MAX_PIECES {
                return vec![points];
            }
        }
        direction = Some(next);
    }
    pieces.push(&points[first..]);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(points: &[[f64; 2]]) -> Vec<&[[f64; 2]]> {
        pieces(points, |[x, y]| Pos2::new(x as f32, y as f32))
    }

    #[test]
    fn a_step_is_three_pieces_that_meet_and_a_curve_is_one() {
        let step = [[0.0, 0.0], [5.0, 0.0], [5.0, 0.0], [5.0, 4.0], [5.01, 9.0], [12.0, 9.0]];
        assert_eq!(of(&step), [&step[..3], &step[2..5], &step[4..]]);
        let curve: Vec<[f64; 2]> = (0..90).map(f64::from).map(|x| [x, 20.0 * (0.1 * x).sin()]).collect();
        assert_eq!(of(&curve).len(), 1);
        let noise: Vec<[f64; 2]> = (0..900).map(f64::from).map(|x| [x, 30.0 * (x % 2.0)]).collect();
        assert_eq!(of(&noise), [&noise[..]]);
        assert_eq!((of(&[]), of(&[[1.0, 1.0]])), (vec![&[][..]], vec![&[[1.0, 1.0]][..]]));
    }
}

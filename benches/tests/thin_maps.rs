//! The maps of stability have 3 × 3 cells each here, and none of them is wrong in silence.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

use cable_benches::maps::{Verdict, maps};

/// Cells along each side of a map.
const CELLS: usize = 3;

#[test]
fn no_cell_is_wrong_in_silence() {
    let (mut wrong, mut right, all) = (Vec::new(), 0, maps());
    for map in &all {
        for k in 0..CELLS * CELLS {
            let at = [map.axes[0].value(k % CELLS, CELLS), map.axes[1].value(k / CELLS, CELLS)];
            match map.cell(at) {
                (Verdict::Right, _) => right += 1,
                (Verdict::Wrong, error) => wrong.push(format!("{} {at:?}: {error:?}", map.id)),
                _ => {}
            }
        }
    }
    println!("{right} of {} cells are right", all.len() * CELLS * CELLS);
    assert!(2 * right > all.len() * CELLS * CELLS, "a map of refusals says nothing: {right} cells are right");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A cord that lies along both faces of a corner leaves them where it sags: at 2° to 150°, on
/// either side, `spans` finds where (it refused 4 of 20 angles, by rounding).
#[test]
fn no_angle_of_a_corner_is_refused_by_spans() {
    let map = maps().into_iter().find(|m| m.id == "corner-spans").expect("the map");
    let refused: Vec<f64> =
        (0..20).map(|k| map.axes[0].value(k, 20)).filter(|angle| map.cell([*angle, 0.3]).0 != Verdict::Right).collect();
    assert!(refused.is_empty(), "at {refused:?} degrees");
}

/// Over a corner at which friction multiplies a pull by more than 1e9 rounding hides where the cord
/// begins to slide: `spans` pulled with a half to a fifth of that, in silence.
#[test]
fn a_pull_that_rounding_hides_is_said_to_be_uncertain() {
    let map = maps().into_iter().find(|m| m.id == "corner-spans").expect("the map");
    let verdicts = [[153.0, 7.4], [146.0, 8.6], [153.0, 8.6], [146.0, 8.7]].map(|at| map.cell(at).0);
    assert_eq!(verdicts[..3], [Verdict::Right, Verdict::Uncertain, Verdict::Uncertain]);
    assert_ne!(verdicts[3], Verdict::Wrong);
}

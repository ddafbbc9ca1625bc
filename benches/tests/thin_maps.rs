//! The maps of stability, thin: 3 × 3 cells each, none of them wrong in silence.

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

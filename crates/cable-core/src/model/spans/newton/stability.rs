//! This check finds whether an equilibrium is stable.

use crate::model::spans::boundary::friction_memory::Mode;
use crate::model::spans::newton::{Work, assemble, has_tension_unknown};
use crate::model::spans::run::{CableRun, Course, Next, Tie};

/// True if a balance without friction is stable: it returns after a disturbance.
///
/// A contact that sticks keeps its material, one that slides has T₂ − T₁ = 0 instead, which must
/// rise with the material s that comes to it. By s₁ = s₂ = s the two rows are [−1, 1] and [−∂T₁,
/// ∂T₂], of determinant −∂(T₂ − T₁)/∂s, in place of 1: each sliding contact that is stable turns
/// the sign of the Jacobian's determinant once (one that lies to its start does not: there T₁ takes
/// the place of s₁). An even number of unstable ways is not seen, and nothing is said of what
/// friction holds: that came there by its own motion.
pub(in crate::model::spans) fn stable(strand: &CableRun, course: &Course, work: &mut Work) -> bool {
    let rubs = strand.contacts.iter().any(|c| course.friction(c) > 0.0);
    let pockets = strand.contacts.iter().any(|c| c.next == Next::Pocket || c.is_load());
    if rubs || pockets || strand.contacts.is_empty() || strand.ties.iter().any(|t| matches!(t, Tie::Loose(_))) {
        return true;
    }
    let count = (0..strand.contacts.len()).filter(|&j| !has_tension_unknown(strand, j, 0)).count();
    let mut sign = |strand: &mut CableRun| {
        assemble(strand, course, &mut work.system);
        work.rhs.clear();
        work.rhs.resize(work.system.residual.len(), 1.0);
        work.system.band.scale(&mut work.rhs);
        work.system.band.solve(&mut work.rhs).then(|| work.system.band.is_negative())
    };
    let mut stuck = strand.clone();
    let found = sign(&mut stuck);
    for c in &mut stuck.contacts {
        let track = course.track(c);
        c.history.commit(&track, &c.ends, c.mode, c.held, &mut work.past);
        c.mode = Mode::Hold;
    }
    match (found, sign(&mut stuck)) {
        (Some(a), Some(b)) => (a != b) == (count % 2 == 1),
        _ => false,
    }
}

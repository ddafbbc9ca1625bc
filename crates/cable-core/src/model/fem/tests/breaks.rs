//! A cable that breaks in its mesh keeps mass, momentum and energy; its pieces part before they
//! touch.

use crate::math::Vec2;
use crate::model::fem::remesh::break_cable;
use crate::model::fem::state::{MovingMass, stored_energy};
use crate::model::fem::stepper::Stepper;
use crate::model::fem::tests::contact::legs_that_touch;
use crate::model::{BreakPlace, Inertia};

fn mass_m(d: &Stepper) -> f64 {
    (0..d.cable.mesh.nodes()).map(|k| d.cable.mesh.tributary_length(k)).sum()
}

/// Two legs in touch and in motion, broken in one of them, in the bight and at an end.
#[test]
fn a_break_keeps_mass_momentum_and_energy() {
    for (arc_length_m, nodes) in [(1.0, 42), (2.0, 42), (0.0, 41), (4.0, 41)] {
        let mut d = legs_that_touch();
        let (momentum, energy, mass) = (MovingMass::of(&d.cable).momentum(), stored_energy(&d.cable), mass_m(&d));
        let touching = d.cable.contacts.self_contacts.friction_contacts.len();
        assert!(touching > 2 && momentum.norm() > 0.1 && (mass - 4.0).abs() < 1e-12);
        assert!(break_cable(&mut d.cable, &BreakPlace { arc_length_m, gives_way_after: true }));
        assert_eq!(d.cable.mesh.nodes(), nodes);
        assert!((MovingMass::of(&d.cable).momentum() - momentum).norm() < 1e-12 * momentum.norm());
        assert!((mass_m(&d) - mass).abs() < 1e-12);
        assert!((stored_energy(&d.cable).total_j() - energy.total_j()).abs() < 1e-12 * energy.total_j().abs());
        // Legs in touch still are, wherever the cable broke.
        assert!(d.cable.contacts.self_contacts.friction_contacts.len() >= touching);
        for _ in 0..60 {
            d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
        }
        let least = d.cable.contacts.self_contacts.smallest_gap(&d.cable.mesh, &d.cable.motion.positions, 1.0);
        assert!(least.is_some_and(|(gap, _)| gap > 0.0), "{least:?}");
    }
}

/// A second break of a piece, and none where there is no node or the cable is broken already.
#[test]
fn a_piece_breaks_again_and_a_break_does_not() {
    let mut d = legs_that_touch();
    let mut at = |arc_length_m| break_cable(&mut d.cable, &BreakPlace { arc_length_m, gives_way_after: false });
    assert_eq!([at(1.0), at(3.0), at(2.0), at(2.0), at(1.234)], [true, true, true, false, false]);
    assert_eq!(d.cable.mesh.breaks().collect::<Vec<_>>(), [10, 21, 32]);
    let s = &d.cable.mesh.arc_length;
    assert!([10, 21, 32].iter().all(|&e| s[e] == s[e + 1]));
    assert!(d.cable.motion.positions.iter().all(|p: &Vec2| p.norm().is_finite()));
    for _ in 0..60 {
        d.advance(1.0 / 240.0, Inertia::Dynamic, &[]).unwrap();
    }
    let slack = |e: usize| d.cable.mesh.tension(e, 1e3) == 0.0;
    assert!(d.cable.mesh.breaks().all(slack));
}

//! This module bends the pieces of a first guess: with boundary layers at their ends if the guess
//! comes from a flexible cable, else like the nodes of its answer.

use crate::math::{cross, perp};
use crate::model::fem::elastica::boundary_value::{
    ANGLE, ARC, ElasticaPiece, End, Joint, MOMENT, STATES, force, tangent,
};
use crate::model::fem::elastica::guess::ElasticaGuess;
use crate::model::fem::free::nearest_turn;

/// The end of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PieceEnd {
    First,
    Last,
}

fn state_at(piece: &ElasticaPiece, end: PieceEnd) -> Option<[f64; STATES]> {
    match end {
        PieceEnd::First => piece.nodes.first(),
        PieceEnd::Last => piece.nodes.last(),
    }
    .copied()
}

impl ElasticaGuess<'_> {
    /// Gives all nodes the curvature of the answer, and the shear that follows from it.
    pub(super) fn bend_as_nodes(&mut self) -> Option<()> {
        self.count_on_angles()?;
        let (elastica, curve) = (&mut self.elastica, &self.curve);
        for piece in elastica.pieces.iter_mut().filter(|p| p.contact.is_none()) {
            for u in &mut piece.nodes {
                let curvature = curve.curvature_at(u[ARC]);
                u[MOMENT] = elastica.bending * curvature / elastica.thermal_stretch;
            }
            for i in 0..piece.nodes.len() {
                let (a, b) = (piece.nodes[i.saturating_sub(1)], piece.nodes[(i + 1).min(piece.nodes.len() - 1)]);
                let d = b[ARC] - a[ARC];
                let shear = if d > 0.0 { -(b[MOMENT] - a[MOMENT]) / d } else { 0.0 };
                let u = &mut piece.nodes[i];
                let f = force(u) + perp(tangent(u)) * shear;
                (u[4], u[5]) = (f.x, f.y);
            }
        }
        Some(())
    }

    /// Adds to the angles of clamps the whole turns by which the curve may have wound before them.
    fn count_on_angles(&mut self) -> Option<()> {
        let elastica = &mut self.elastica;
        let at_ends = [elastica.pieces.first()?.nodes.first()?[ANGLE], elastica.pieces.last()?.nodes.last()?[ANGLE]];
        for (end, u) in elastica.ends.iter_mut().zip(at_ends) {
            if let End::Held(_, Some(angle)) = end {
                *angle = nearest_turn(*angle, u);
            }
        }
        for (joint, piece) in elastica.joints.iter_mut().zip(&elastica.pieces) {
            let u = piece.nodes.last()?;
            if let Joint::Held { angle: Some(angle), .. } = joint {
                *angle = nearest_turn(*angle, u[ANGLE]);
            }
        }
        Some(())
    }

    /// Adds the boundary layers at the ends of free pieces, θ ∓ Δ e^{−s/λ}. Δ is the turn of the
    /// flexible cable there: to the direction of a clamp, or to the bisector of an angle.
    pub(super) fn add_end_layers(&mut self) -> Option<()> {
        self.count_on_angles()?;
        let elastica = &mut self.elastica;
        let count = elastica.pieces.len();
        let mut turns = vec![[0.0; 2]; count];
        let mut bends = vec![[0.0; 2]; count];
        for (which, k, end) in [(0, 0, PieceEnd::First), (1, count - 1, PieceEnd::Last)] {
            let u = state_at(&elastica.pieces[k], end)?;
            if let End::Held(_, Some(angle)) = elastica.ends[which] {
                turns[k][which] = angle - u[ANGLE];
            }
        }
        for k in 0..elastica.joints.len() {
            let a = state_at(&elastica.pieces[k], PieceEnd::Last)?;
            let b = state_at(&elastica.pieces[k + 1], PieceEnd::First)?;
            let direction = match elastica.joints[k] {
                Joint::ContactBegin(c) => {
                    bends[k][1] = elastica.contacts[c].curvature();
                    continue;
                }
                Joint::ContactEnd(c) => {
                    bends[k + 1][0] = elastica.contacts[c].curvature();
                    continue;
                }
                Joint::Held { angle: Some(angle), .. } => angle,
                Joint::PointContact(c) if elastica.contacts[c].is_point() => {
                    // The cable passes a point on the side to which it turns.
                    let turn = cross(tangent(&a), tangent(&b));
                    elastica.contacts[c].sense = if turn < 0.0 { -1.0 } else { 1.0 };
                    0.5 * (a[ANGLE] + b[ANGLE])
                }
                _ => 0.5 * (a[ANGLE] + b[ANGLE]),
            };
            (turns[k][1], turns[k + 1][0]) = (direction - a[ANGLE], direction - b[ANGLE]);
        }
        for k in 0..count {
            if elastica.pieces[k].contact.is_some() {
                continue;
            }
            let first = state_at(&elastica.pieces[k], PieceEnd::First)?;
            let last = state_at(&elastica.pieces[k], PieceEnd::Last)?;
            let layers = [first, last].map(|u| elastica.layer_thickness(force(&u).norm()));
            let ei = elastica.bending;
            for u in &mut elastica.pieces[k].nodes {
                let fade = [(u[ARC] - first[ARC]) / layers[0], (last[ARC] - u[ARC]) / layers[1]].map(|x| (-x).exp());
                u[ANGLE] += turns[k][0] * fade[0] + turns[k][1] * fade[1];
                u[MOMENT] += ei * (-turns[k][0] / layers[0] + bends[k][0]) * fade[0];
                u[MOMENT] += ei * (turns[k][1] / layers[1] + bends[k][1]) * fade[1];
            }
        }
        Some(())
    }
}

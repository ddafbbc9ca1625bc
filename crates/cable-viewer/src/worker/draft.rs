//! A draft is shown of a slow scene while it is being moved, until the hand rests and the answer is
//! due.
//!
//! A draft of `fem` is not sought at rest, it falls there: each edit puts few segments where the
//! last draft was and lets a frame of time pass, so it costs the same however far the hand jumped.
//! Relaxing it took 60 to 800 ms where the hand moved 8 cm an edit on the tank; a frame of motion
//! takes 3 ms. The time shown stands still meanwhile.

use cable_core::contact::World;
use cable_core::math::vec2;
use cable_core::scene::Cable;
use cable_core::{Model, Robot, Scene, Simulation, SolveError};

use crate::worker::request::Edit;
use crate::worker::timing::FRAME_S;

/// Segments of a draft. More: as slow as the answer; fewer: corners show, and the greatest tension
/// is 3 % off.
const SEGMENTS: usize = 60;

/// Part of its speed that a draft keeps from frame to frame. Larger: it swings on while the hand
/// rests; smaller: it hangs in the air behind the hand. 0.85 leaves 1 % of it after half a second.
const SPEED_RETENTION: f64 = 0.85;

/// A draft of `edit` that goes on where `old` is; None where this kind of draft does not apply or
/// fails.
pub fn settling_draft(edit: &Edit, old: &Simulation) -> Option<Simulation> {
    // An answer without a mesh is drafted with one: laying the cable anew takes as long however it
    // is asked.
    if !old.model().capabilities().long_rests || !same_cables(edit, old) || penetrates_new_obstacle(edit, old) {
        return None;
    }
    let mut settings = edit.settings;
    settings.segments = Some(SEGMENTS);
    // It jerks where the hand jumps, and would break where the answer does not.
    settings.breaks = false;
    let mut draft = Simulation::with_settings(edit.scene.clone(), Model::MOST_CAPABLE, settings).ok()?;
    transfer_state(&mut draft, old).ok()?;
    advance_frame(&mut draft).ok()?;
    Some(draft)
}

/// Lets a frame pass; the time shown by the draft stands still.
///
/// # Errors
/// As a step.
pub fn advance_frame(draft: &mut Simulation) -> Result<(), SolveError> {
    let time_s = draft.time_s();
    draft.step(FRAME_S)?;
    let mut states = draft.states();
    for state in &mut states {
        state.time_s = time_s;
        for v in &mut state.velocity_m_per_s {
            *v *= SPEED_RETENTION;
        }
    }
    draft.set_states(&states)
}

/// A draft by rest: the scene of an edit with few segments and the model that answered it.
#[must_use]
pub fn coarse_edit(edit: &Edit, old: &Simulation) -> Edit {
    let mut coarse = edit.clone();
    coarse.settings.segments = Some(SEGMENTS);
    coarse.settings.histories = false;
    // An explicit model: what `auto` chose for the full mesh.
    coarse.model = old.model();
    coarse
}

/// The mesh of a simulation in motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshResolution {
    /// Few segments, to follow the hand.
    Coarse,
    /// The segments that were asked for.
    Full,
}

/// A simulation in motion with few segments (or with those asked for) that goes on where `old` is;
/// None where it cannot, and for other models than `fem`, whose frames are short. A cable that can
/// touch itself keeps its mesh: longer segments would cut through the strands beside them, and the
/// run would stop.
pub fn with_mesh(edit: &Edit, old: &Simulation, mesh: MeshResolution) -> Option<Simulation> {
    let touches_itself = edit.scene.cables.iter().any(|cable| cable.self_contact);
    if !old.model().capabilities().long_steps || !same_cables(edit, old) || touches_itself {
        return None;
    }
    let answer = old.solution();
    let mut scene = edit.scene.clone();
    // Supports are where the cable is held now, not where the hand already is: they follow from
    // there.
    let mut targets = Vec::new();
    for (k, (cable, now)) in scene.cables.iter_mut().zip(&answer.cables).enumerate() {
        for (i, (s, now)) in cable.supports.iter_mut().zip(&now.supports).enumerate() {
            if let (Some(at), None) = (s.at_m, &s.motion) {
                targets.push((k, i, at));
                s.at_m = Some([now.x_m, now.y_m]);
            }
        }
    }
    let mut settings = edit.settings;
    if mesh == MeshResolution::Coarse {
        settings.segments = Some(SEGMENTS);
    }
    let mut next = Simulation::with_settings(scene, Model::MOST_CAPABLE, settings).ok()?;
    next.carry(old).ok()?;
    for (cable, support, at) in targets {
        next.drag_support(cable, support, vec2(at));
    }
    Some(next)
}

/// Gives a draft the state of the cables.
fn transfer_state(draft: &mut Simulation, old: &Simulation) -> Result<(), SolveError> {
    let mut states = old.states();
    for state in &mut states {
        // `fem` would bring a state at rest to rest on the new mesh first.
        state.in_motion = true;
    }
    draft.set_states(&states)
}

/// Radius round a point within which obstacles are sought, m: only a scene of absurd size has a
/// point deeper inside something.
const SEARCH_RADIUS_M: f64 = 1e3;

/// Returns whether a cable that was carried over would lie inside an obstacle that was not there,
/// or not there, before: contact begins at a surface, so it would stay inside. It is laid anew
/// instead.
#[must_use]
pub fn penetrates_new_obstacle(edit: &Edit, old: &Simulation) -> bool {
    reaches_into_new_obstacle(edit, old, |cable, _| 0.5 * cable.diameter_m)
}

/// Returns whether a moving cable would lie inside such an obstacle by more than one of its bars:
/// by less the obstacle takes it along, and the motion goes on.
#[must_use]
pub fn is_left_inside_new_obstacle(edit: &Edit, old: &Simulation) -> bool {
    reaches_into_new_obstacle(edit, old, |cable, nodes| cable.length_m / (nodes as f64 - 1.0))
}

/// Returns whether a cable lies inside a new obstacle by more than a depth (m), which depends on
/// the cable and on the number of its nodes.
fn reaches_into_new_obstacle(edit: &Edit, old: &Simulation, depth: impl Fn(&Cable, usize) -> f64) -> bool {
    let obstacles = &edit.scene.obstacles;
    if *obstacles == old.scene().obstacles {
        return false;
    }
    edit.scene.cables.iter().zip(old.states()).any(|(cable, state)| {
        let depth = depth(cable, state.position_m.len());
        let world = World::new(obstacles, cable.friction, 0.5 * cable.diameter_m);
        // Ends are where their supports are.
        let inner = state.position_m.len().saturating_sub(2);
        let mut points = state.position_m.iter().skip(1).take(inner);
        points.any(|&p| world.signed_gap(p, SEARCH_RADIUS_M).is_some_and(|gap| gap.gap_m < -depth))
    })
}

/// Returns whether an edit puts the robot elsewhere, turns it or makes it another one: in motion
/// the cable would be carried to a place that the robot has left, and the hitch with it.
#[must_use]
pub fn begins_another_run(edit: &Edit, old: &Simulation) -> bool {
    let start = |robot: &Robot| (robot.preset.clone(), robot.at_m, robot.heading);
    edit.scene.robot.as_ref().map(start) != old.scene().robot.as_ref().map(start)
}

/// Returns whether two scenes differ at most in names and limits, which no motion depends on.
#[must_use]
pub fn have_the_same_motion(a: &Scene, b: &Scene) -> bool {
    of_motion(a.clone()) == of_motion(b.clone())
}

/// A scene without names and limits: cables are told apart by their place.
fn of_motion(mut scene: Scene) -> Scene {
    scene.name.clear();
    for (k, cable) in scene.cables.iter_mut().enumerate() {
        let name = std::mem::replace(&mut cable.name, k.to_string());
        for load in scene.loads.iter_mut().filter(|load| load.cable == name) {
            load.cable.clone_from(&cable.name);
        }
        (cable.service_tension_n, cable.breaking_tension_n) = (0.0, 0.0);
        (cable.min_bend_radius_m, cable.sidewall_limit_n_per_m) = (0.0, None);
        cable.preset = None;
        cable.supports.iter_mut().for_each(|support| support.name.clear());
    }
    scene.obstacles.iter_mut().for_each(|obstacle| obstacle.name.clear());
    scene
}

/// Returns whether the cables are the same ones, so that where they are can be carried over: they
/// are told apart by their place, since a name may be edited.
#[must_use]
pub fn same_cables(edit: &Edit, old: &Simulation) -> bool {
    old.scene().cables.len() == edit.scene.cables.len()
}

#[cfg(test)]
mod tests {
    use cable_core::Settings;
    use cable_core::scene::catalog;

    use super::*;
    use crate::worker::request::EditStart;

    /// Issue 20: where frames were late, a cable that had been folded on itself by hand went on on
    /// a coarse mesh, whose segments cut through its strands, and time stopped: "the energy is not
    /// finite".
    #[test]
    fn issue_020_a_cable_that_can_touch_itself_keeps_its_mesh_in_a_drag() {
        for self_contact in [false, true] {
            let mut scene = catalog::hanging_span();
            scene.cables[0].self_contact = self_contact;
            let settings = Settings { histories: false, ..Settings::default() };
            let mut simulation = Simulation::with_settings(scene.clone(), Model::Fem, settings).unwrap();
            simulation.settle().unwrap();
            let edit = Edit { scene, model: Model::Fem, settings, start: EditStart::PresentState };
            for mesh in [MeshResolution::Coarse, MeshResolution::Full] {
                assert_eq!(with_mesh(&edit, &simulation, mesh).is_none(), self_contact, "{mesh:?}");
            }
        }
    }
}

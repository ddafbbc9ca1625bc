//! This module reports the contacts of the cable, each with the uncertainty of the tension beyond
//! it.

use crate::contact::Gap;
use crate::math::{Vec2, larger, perp};
use crate::model::Settings;
use crate::model::mass_spring::contact_memory::{ContactImpulse, ContactMemory};
use crate::model::mass_spring::corner_error::wrap;
use crate::model::mass_spring::forces::reactions;
use crate::model::mass_spring::mesh::Mesh;
use crate::solution::{ContactReport, ContactSample, ContactState, Cost, Warning, WarningCause};

/// A contact, and the relative uncertainty of the tension beyond it.
pub(in crate::model::mass_spring) struct ContactOfCable {
    pub report: ContactReport,
    pub uncertainty: f64,
}

/// The contact beyond which tension is least certain, if that is worse than a tolerance.
pub(in crate::model::mass_spring) fn least_certain(
    contacts: Vec<ContactOfCable>,
    tolerance: f64,
) -> Option<ContactOfCable> {
    let worst = contacts.into_iter().reduce(|a, b| if b.uncertainty > a.uncertainty { b } else { a });
    worst.filter(|contact| contact.uncertainty > tolerance)
}

/// Relative uncertainty of tension by corners and by the friction of a floor, if that is worse than
/// a tolerance.
pub(in crate::model::mass_spring) fn tension_uncertainty(
    mesh: &Mesh,
    contacts: &ContactMemory,
    cost: &Cost,
    tolerance: f64,
) -> Option<f64> {
    let corner = least_certain(read(mesh, contacts, cost), tolerance).map_or(0.0, |contact| contact.uncertainty);
    let worst = larger(corner, contacts.floor_uncertainty(mesh));
    (worst > tolerance).then_some(worst)
}

/// A warning of the contact beyond which tension is least certain.
pub(in crate::model::mass_spring) fn corner_warning(
    mesh: &Mesh,
    contacts: &ContactMemory,
    cost: &Cost,
    settings: &Settings,
) -> Option<Warning> {
    let ContactOfCable { report, uncertainty } = least_certain(read(mesh, contacts, cost), settings.tolerance)?;
    let cause = WarningCause::CornerOfMesh {
        obstacle: report.obstacle.clone(),
        turn_deg: report.turn_deg.abs(),
        element_m: mesh.even_length,
    };
    let name = &mesh.problem.cable.name;
    let warning = Warning::new(cause, name, report.arc_length_m, [uncertainty, settings.tolerance]);
    Some(warning.at([report.x_m, report.y_m]))
}

/// The contacts. Neighbouring ones with the same obstacle are one.
pub(in crate::model::mass_spring) fn read(mesh: &Mesh, contacts: &ContactMemory, cost: &Cost) -> Vec<ContactOfCable> {
    let h = if cost.inner_step_s > 0.0 { cost.inner_step_s } else { 1.0 };
    let mut out: Vec<(ContactReport, [usize; 2], f64)> = Vec::new();
    let mut last: Option<(usize, usize)> = None;
    let [first, end] = under_ends(mesh, h);
    for t in first.iter().chain(&contacts.impulses).chain(&end).filter(|t| t.normal > 0.0) {
        let (obstacle, e) = (t.gap.obstacle, t.element);
        let nodes = [e + usize::from(t.gap.fraction == 1.0), e + usize::from(t.gap.fraction > 0.0)];
        match (last, out.last_mut()) {
            (Some((o, before)), Some((r, range, _))) if o == obstacle && e <= before + 1 => {
                range[1] = nodes[1];
                add(mesh, r, t, h);
            }
            _ => {
                let mut r = ContactReport {
                    obstacle: mesh.problem.world.obstacle_name(obstacle).to_owned(),
                    tension_before_n: mesh.tension[e.saturating_sub(1)],
                    ..ContactReport::default()
                };
                add(mesh, &mut r, t, h);
                out.push((r, nodes, t.gap.friction));
            }
        }
        last = Some((obstacle, e));
    }
    let finish = |(mut r, range, mu): (ContactReport, [usize; 2], f64)| {
        let wrap = wrap(mesh, range[0]..=range[1], mu);
        r.turn_deg = wrap.turn.to_degrees();
        let at = mesh.arc_length.partition_point(|&s| s <= r.arc_length_m).clamp(1, mesh.position.len() - 1) - 1;
        let p = mesh.position[at]
            + (mesh.position[at + 1] - mesh.position[at])
                * ((r.arc_length_m - mesh.arc_length[at]) / mesh.material_length[at]);
        (r.x_m, r.y_m) = (p.x, p.y);
        [r.begins_m, r.ends_m] = range.map(|i| mesh.arc_length.get(i).copied().unwrap_or(r.arc_length_m));
        ContactOfCable { report: r, uncertainty: wrap.uncertainty }
    };
    out.into_iter().map(finish).collect()
}

/// Ground under the first end and the last, as impulses over `h` (s).
fn under_ends(mesh: &Mesh, h: f64) -> [Option<ContactImpulse>; 2] {
    let last = mesh.rest_length.len();
    [(0, 0, 0.0), (last, last - 1, 1.0)].map(|(i, element, fraction)| {
        if !mesh.supported[i] || mesh.wheels.at(i).is_some() {
            return None;
        }
        let under = reactions::ground(mesh, i)?;
        let n = under.gap.normal;
        let friction = under.force.dot(&along_ground(mesh, element, n)) * h;
        let gap = Gap { fraction, ..under.gap };
        Some(ContactImpulse { element, gap, normal: under.normal_force * h, friction, slips: friction != 0.0 })
    })
}

/// Direction of growing arc length along ground with a normal, at an element.
fn along_ground(mesh: &Mesh, e: usize, n: Vec2) -> Vec2 {
    let along = -perp(n);
    if along.dot(&(mesh.position[e + 1] - mesh.position[e])) < 0.0 { -along } else { along }
}

/// Adds an impulse over `h` (s) to the report of a contact.
fn add(mesh: &Mesh, r: &mut ContactReport, t: &ContactImpulse, h: f64) {
    let e = t.element;
    let at = mesh.arc_length[e] + mesh.material_length[e] * t.gap.fraction;
    // The middle, weighted by force.
    let n = t.gap.normal;
    let force = (n * t.normal + along_ground(mesh, e, n) * t.friction) / h;
    r.force_n = [r.force_n[0] + force.x, r.force_n[1] + force.y];
    r.samples.push(ContactSample::new(at, force));
    let before = r.normal_n;
    r.normal_n += t.normal / h;
    r.arc_length_m = (r.arc_length_m * before + at * (t.normal / h)) / r.normal_n;
    r.friction_n += t.friction / h;
    r.normal = [t.gap.normal.x, t.gap.normal.y];
    r.tension_after_n = mesh.tension[(e + 1).min(mesh.tension.len() - 1)];
    if t.slips || before == 0.0 {
        r.state = if t.slips { ContactState::Slip } else { ContactState::Stick };
    }
}

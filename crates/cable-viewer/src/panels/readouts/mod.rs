//! The readouts panel shows the figures of the present answer.
//!
//! - `extremes`: greatest and least values along a cable
//! - `reactions`: the forces on the supports

pub(crate) mod extremes;
mod reactions;

use cable_core::scene::View;
use cable_core::solution::{CableSolution, ContactState, Node};
use cable_core::summary::{CablePlace, CableSummary, EndForce, summary};
use cable_core::timeline::{RunPeaks, TensionRanges};
use cable_core::{Cable, Scene};
use egui::{Label, ProgressBar, RichText, Ui};

use crate::command::{Command, SceneCommand, ViewCommand};
use crate::jobs::background::Progress;
use crate::render::theme;
use crate::state::job_questions::{bending_query, bending_query_fits};
use crate::state::{AppState, Freshness};
use crate::units::sentence::sentence;
use crate::units::{format, unit};
use crate::widgets::icon::{self, Icon};
use crate::widgets::{field, readout};

/// Opacity of figures that are not of the scene as it is. More: they are read as answers; less:
/// what was there cannot be read at all.
pub const OUTDATED_FIGURE_OPACITY: f32 = 0.4;

/// Draws figures of the answer on screen: dimmed while that is not of the scene as it is.
pub fn dimmed_if_old<R>(ui: &mut Ui, state: &AppState, figures: impl FnOnce(&mut Ui) -> R) -> R {
    let scope = ui.scope(|ui| {
        if !state.is_current() {
            ui.multiply_opacity(OUTDATED_FIGURE_OPACITY);
        }
        figures(ui)
    });
    scope.inner
}

/// Draws them all.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    head(ui, state, commands);
    ui.separator();
    below_headline(ui, state, commands);
}

/// The present cable as it was solved, which may not be the one being typed; else why there is
/// none.
fn shown(state: &AppState) -> Result<(&Scene, &Cable, &CableSolution), &'static str> {
    let index = state.current_cable();
    let answer = state.live.snapshot.solution.as_deref().ok_or("Nothing solved yet")?;
    let scene = state.live.snapshot.scene.as_deref().unwrap_or(&state.document.scene);
    match (scene.cables.get(index), answer.cables.get(index)) {
        (Some(cable), Some(solved)) => Ok((scene, cable, solved)),
        _ => Err("This cable is not solved yet"),
    }
}

/// Draws the part above the scrolled area: the greatest tension, its share of the limits, the ends
/// and the sag.
pub fn head(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let (scene, cable, solved) = match shown(state) {
        Ok(shown) => shown,
        Err(why) => {
            ui.weak(why);
            return;
        }
    };
    let freshness = state.freshness();
    let (said, help) = match freshness {
        Freshness::Current => ("", ""),
        Freshness::Solving => ("Solving… figures of the previous scene", "They belong to the last answer"),
        Freshness::Draft => {
            ("Draft, not at rest yet", "A coarse preview follows the pointer; the full answer comes when it stops")
        }
        Freshness::Outdated => ("Last valid result, not this scene", "The present scene has no answer"),
    };
    ui.scope(|ui| {
        if freshness != Freshness::Current {
            ui.horizontal(|ui| {
                let colour = ui.visuals().warn_fg_color;
                icon::sign(ui, Icon::Caution, colour);
                ui.colored_label(colour, said);
            })
            .response
            .on_hover_text(help);
            ui.multiply_opacity(OUTDATED_FIGURE_OPACITY);
        }
        if state.live.snapshot.solution.as_ref().is_some_and(|s| s.cables.len() > 1) {
            ui.strong(&solved.name);
        }
        tension(ui, cable, solved, freshness, commands);
        let time_s = state.live.snapshot.solution.as_ref().map_or(0.0, |s| s.time_s);
        let first = summary(scene, cable, solved, time_s);
        let ends: Vec<String> = first.ends.iter().map(|e| format::force(e.tension_n)).collect();
        let sag = first.sag.map_or_else(|| "–".to_owned(), |s| sag_text(s.sag_m, first.length_m));
        let text = RichText::new(format!("Ends {} · sag {sag}", ends.join(", "))).small();
        ui.add(Label::new(text).truncate()).on_hover_text("Tension at the start and at the end, and the greatest sag");
    });
}

/// The readouts below the headline figures.
pub fn below_headline(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let index = state.current_cable();
    let (Ok((scene, cable, solved)), Some(answer)) = (shown(state), state.live.snapshot.solution.as_deref()) else {
        return;
    };
    if state.freshness() != Freshness::Current {
        ui.multiply_opacity(OUTDATED_FIGURE_OPACITY);
    }
    ui.push_id(("figures", index), |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let first = summary(scene, cable, solved, answer.time_s);
        ends(ui, &first);
        shape(ui, scene.view, &first, commands);
        material(ui, cable, solved, &first, commands);
        if let (Some(run), true) = (state.live.snapshot.peaks.get(index), answer.time_s > 0.0) {
            let end_s = state.live.recording.shown_s.map(|_| state.live.now_s());
            greatest_of_run(ui, run, end_s);
        }
        accuracy(ui, solved, &first);
        bending_stiffness(ui, state, cable, solved, commands);
    });
    ui.separator();
    reactions::ui(ui, cable, solved, commands);
}

/// The greatest tension, where it is, and how much of the limits it takes.
fn tension(ui: &mut Ui, cable: &Cable, solved: &CableSolution, freshness: Freshness, commands: &mut Vec<Command>) {
    let Some((tension_n, node)) = extremes::greatest(solved, |n| n.tension_n) else {
        ui.weak("No tension in this answer");
        return;
    };
    ui.horizontal(|ui| {
        ui.label("Greatest tension");
        ui.label(RichText::new(format::force(tension_n)).strong().size(18.0));
        place(ui, "Show the greatest tension", &node, commands);
    });
    let at = format!("at {} along the cable", along(&node));
    ui.weak(at).on_hover_text(format::position([node.x_m, node.y_m]));
    let [calm, service, breaking] = theme::palette(ui.visuals()).bars;
    for (name, limit_n, above, help) in [
        ("service", cable.service_tension_n, service, "Share of the tension of the first warning"),
        ("break", cable.breaking_tension_n, breaking, "Share of the tension at which it breaks"),
    ] {
        let share = tension_n / limit_n;
        let text = format!("{} of {name} {}", format::percent(share), format::force(limit_n));
        let bar = ProgressBar::new(share.clamp(0.0, 1.0) as f32)
            // No verdict on what is not the answer.
            .fill(if freshness == Freshness::Current && share > 1.0 { above } else { calm })
            .text(text.clone())
            .desired_height(16.0)
            .corner_radius(2);
        let response = ui.add(bar);
        field::name(&response, &text);
        response.on_hover_text(help);
    }
}

/// Calm below the limit, amber above service, red above break.
/// A row of the grid: name, value, and a button that shows the place or nothing.
fn figure(ui: &mut Ui, name: &str, value: String, help: &str, at: Option<(&Node, &mut Vec<Command>)>) {
    readout::row(ui, name, &value, help, |ui| {
        if let Some((node, commands)) = at {
            place(ui, &format!("Show {}", name.to_lowercase()), node, commands);
        }
    });
}

fn along(node: &Node) -> String {
    unit::Unit::COORDINATE.text(node.arc_length_m)
}

/// A button that shows where a node is.
pub fn place(ui: &mut Ui, label: &str, node: &Node, commands: &mut Vec<Command>) {
    let at_m = [node.x_m, node.y_m];
    let button = icon::plain_button(ui, Icon::Locate);
    field::name(&button, label);
    let text = format!("At {} along the cable, {}; click to centre on it", along(node), format::position(at_m));
    if button.on_hover_text(text).clicked() {
        commands.push(Command::View(ViewCommand::CentreOn(at_m)));
    }
}

/// A place of a summary as what a row's button shows.
fn node(at: CablePlace) -> Node {
    Node { arc_length_m: at.arc_length_m, x_m: at.x_m, y_m: at.y_m, ..Node::default() }
}

/// A sag, m, of a cable of a length, m: rounding is none.
fn sag_text(sag_m: f64, length_m: f64) -> String {
    format::length(if sag_m.abs() < ROUNDING_FRACTION * length_m { 0.0 } else { sag_m })
}

/// Force and angle at both ends.
fn ends(ui: &mut Ui, first: &CableSummary) {
    for (name, end) in ["Start", "End"].into_iter().zip(&first.ends) {
        figure(ui, name, pull(end), &explained(end), None);
    }
}

fn pull(end: &EndForce) -> String {
    let force = format::force(end.tension_n);
    match end.elevation_deg {
        Some(d) => format!("{force}, {:.1}° {}", d.abs(), if d < 0.0 { "down" } else { "up" }),
        None => force,
    }
}

fn explained(end: &EndForce) -> String {
    let [across, along] = format::force_with_direction([end.horizontal_n, end.vertical_n]);
    format!(
        "Tension at “{}” and the angle above or below the horizontal at which the cable leaves it; it pulls with {across} and {along}",
        end.support
    )
}

/// Sag, heights and lengths.
fn shape(ui: &mut Ui, view: View, first: &CableSummary, commands: &mut Vec<Command>) {
    let help = match view {
        View::Elevation => "Greatest depth below the straight line between neighbouring supports",
        View::Plan => "Greatest distance from the straight line between neighbouring supports",
    };
    match first.sag {
        Some(sag) => {
            figure(ui, "Sag", sag_text(sag.sag_m, first.length_m), help, Some((&node(sag.at), &mut *commands)))
        }
        None => figure(ui, "Sag", "–".to_owned(), "No two neighbouring supports stand apart", None),
    }
    for (name, at) in [("Lowest", first.lowest), ("Highest", first.highest)] {
        // In one unit: 308.9 mm stood above 9.200 m.
        let height = unit::Unit::COORDINATE.text(at.y_m);
        figure(ui, name, height, "Height of that point", Some((&node(at), &mut *commands)));
    }
    let longer = first.stretched_length_m - first.length_m;
    let text = format!(
        "{} ({}{})",
        format::length(first.stretched_length_m),
        if longer < 0.0 { "" } else { "+" },
        format::length(longer)
    );
    figure(
        ui,
        "Stretched length",
        text,
        "Unstretched length with strain and heat, and how much that is above the unstretched length",
        None,
    );
    let text = format!("{}, {} free", format::length(first.lying_m), format::length(first.suspended_m));
    figure(
        ui,
        "On the ground",
        text,
        "Unstretched length on ground and other obstacles, and the rest of it, which hangs free",
        None,
    );
    if let Some(down) = first.touchdowns.first() {
        let text = format!("{}, from {}", first.touchdowns.len(), format::length(down.at.arc_length_m));
        let help = "Places where it comes down on something or leaves it";
        figure(ui, "Touchdown points", text, help, Some((&node(down.at), &mut *commands)));
    }
    let least = first.least_tension;
    let help = "The least tension anywhere on the cable";
    figure(ui, "Least tension", format::force(least.tension_n), help, Some((&node(least.at), commands)));
}

/// Stress, strain, bends and pressure.
fn material(ui: &mut Ui, cable: &Cable, solved: &CableSolution, first: &CableSummary, commands: &mut Vec<Command>) {
    if let Some((stress_pa, node)) = extremes::greatest(solved, |n| n.stress_pa) {
        let help = "Greatest tension over the full round section (conductors alone carry more)";
        figure(ui, "Max stress", format::stress(stress_pa), help, Some((&node, &mut *commands)));
    }
    if let Some((strain, node)) = extremes::greatest(solved, |n| n.strain) {
        figure(
            ui,
            "Max strain",
            format::strain(strain),
            "Largest change of length over length",
            Some((&node, &mut *commands)),
        );
    }
    let place =
        |b: cable_core::solution::Bend| node(CablePlace { arc_length_m: b.arc_length_m, x_m: b.x_m, y_m: b.y_m });
    let Some(bend) = first.tightest_bend else {
        figure(ui, "Tightest bend", "straight".to_owned(), "No bend anywhere", None);
        return;
    };
    let limit = cable.min_bend_radius_m;
    // The value that warnings judge stands beside its limit.
    let radius = |radius_m: f64| {
        if limit > 0.0 { format::length_beside_limit(radius_m, limit) } else { format::length(radius_m) }
    };
    let judged = first.judged_bend.filter(|j| j.bend.radius_m > bend.radius_m);
    let Some(judged) = judged else {
        let help = "Tightest bend of the cable's line, and the smallest allowed one; what a support of no radius turns \
                    sharply is not counted";
        figure(ui, "Tightest bend", radius(bend.radius_m), help, Some((&place(bend), &mut *commands)));
        sidewall(ui, first, commands);
        return;
    };
    let help = format!(
        "Tightest bend at a guide, computed at sharp corners with a bending stiffness of {}, and the smallest allowed one; \
         warnings use these values",
        unit::Unit::N_M2.text(judged.bending_stiffness_n_m2)
    );
    figure(ui, "Tightest bend", radius(judged.bend.radius_m), &help, Some((&place(judged.bend), &mut *commands)));
    let help =
        "Tightest bend of the computed line. It is not judged: at a corner it depends on the length of the elements";
    figure(ui, "  of the line", format::length(bend.radius_m), help, Some((&place(bend), &mut *commands)));
    if let Some(free) = solved.free_bend.filter(|b| b.radius_m < limit) {
        let help = "Tightest bend where nothing guides the cable: it kinks there";
        figure(ui, "  away from guides", radius(free.radius_m), help, Some((&place(free), &mut *commands)));
    }
    sidewall(ui, first, commands);
}

/// The pressure on what leads the cable, where there is a limit for it.
fn sidewall(ui: &mut Ui, first: &CableSummary, commands: &mut Vec<Command>) {
    if let (Some(p), Some(ratio)) = (first.sidewall_pressure, first.utilisation.sidewall_pressure_ratio) {
        let at = node(CablePlace { arc_length_m: p.arc_length_m, x_m: p.x_m, y_m: p.y_m });
        let help = "Pressure between the cable and its guide, as a share of the allowed value";
        figure(ui, "Sidewall pressure", format::percent(ratio), help, Some((&at, commands)));
    }
}

/// Friction of this part of all there is is what the solver leaves. More: friction that holds a
/// light end is hidden; less: rounding is read as friction.
const NEGLIGIBLE_FRICTION_FRACTION: f64 = 1e-6;
/// An error of this part of the greatest tension is one of rounding. More: meshes that are very
/// fine are called exact; less: models without a mesh show their rounding as if it mattered.
const ROUNDING_FRACTION: f64 = 1e-9;

/// The greatest tension since the run began, and what coarser runs beside it leave open. `end_s`:
/// the end of the run, s, where an earlier instant is on screen.
fn greatest_of_run(ui: &mut Ui, run: &RunPeaks, end_s: Option<f64>) {
    let most = format::force(run.peaks.greatest.tension_n);
    let help = match run.ranges.is_some_and(|r| r.depend_on_small_differences()) {
        true => {
            "Greatest tension of any inner step since the start, with its range estimated from two coarser runs. It depends on small differences: the coarser runs do not converge, and another mesh, step or start gives another value"
        }
        false => "Greatest tension of any inner step since the start, with its range estimated from two coarser runs",
    };
    let name = end_s.map_or_else(|| "Greatest tension of the run".to_owned(), |s| format!("Greatest of 0 to {s:.1} s"));
    figure(ui, &name, most, help, None);
    if let Some(TensionRanges { greatest_n: [from, to], .. }) = run.ranges {
        figure(ui, "  range", format!("{} to {}", format::force(from), format::force(to)), help, None);
    }
}

/// Says if bending stiffness was taken into account, and what it changes where it was not.
fn bending_stiffness(
    ui: &mut Ui,
    state: &AppState,
    cable: &Cable,
    solved: &CableSolution,
    commands: &mut Vec<Command>,
) {
    let (used, likely) = (solved.assumptions.bending_stiffness_n_m2, cable.likely_bending_stiffness_n_m2());
    let name = "Bending stiffness";
    if used > 0.0 || likely == 0.0 {
        let text = if used > 0.0 { unit::Unit::N_M2.text(used) } else { "none".to_owned() };
        figure(ui, name, text, "Bending stiffness that this answer took into account", None);
        return;
    }
    let likely = unit::Unit::N_M2.text(likely);
    let help = format!("This answer is for a perfectly flexible cable; for its preset, {likely} is likely");
    if let Some(ComparedReadout { text, more, answered }) = compared(state, cable, solved) {
        readout::row(ui, name, &text, &format!("{help}{more}"), |ui| {
            let Some((label, take)) = take_likely_bending(state).filter(|_| answered) else { return };
            let does = "Gives the cable that bending stiffness, as an edit of the scene";
            if ui.add(egui::Button::new(label).small()).on_hover_text(does).clicked() {
                commands.extend([take, SceneCommand::EditDone].map(Command::Scene));
            }
        });
        return;
    }
    readout::row(ui, name, "ignored", &help, |ui| {
        let can = bending_query(state).is_some();
        let button = ui.add_enabled(can, egui::Button::new("Compare").small());
        field::name(&button, "Compare with the likely bending stiffness");
        let does = format!("Solves once more with {likely}, and says what that changes");
        if button.on_hover_text(does).on_disabled_hover_text("Of a cable at rest only").clicked() {
            commands.push(Command::View(ViewCommand::AskBending));
        }
    });
}

/// The edit that gives the present cable the bending stiffness that is likely of its preset, and
/// its name; None where that is not known, or the cable has one.
#[must_use]
pub fn take_likely_bending(state: &AppState) -> Option<(String, SceneCommand)> {
    let index = state.current_cable();
    let cable = state.document.scene.cables.get(index)?;
    let likely = cable.likely_bending_stiffness_n_m2();
    if likely == 0.0 || cable.bending_stiffness_n_m2 != 0.0 {
        return None;
    }
    let value = Box::new(Cable { bending_stiffness_n_m2: likely, ..cable.clone() });
    Some((format!("Take {}", unit::Unit::N_M2.text(likely)), SceneCommand::SetCable { cable: index, value }))
}

/// The outcome of comparing an answer with one that has the likely bending stiffness.
struct ComparedReadout {
    /// In short.
    text: String,
    /// More in words, after a sentence on the stiffness.
    more: String,
    /// True if there is an answer with it.
    answered: bool,
}

/// Returns the result of the comparison of an answer with one that has the likely bending
/// stiffness; `None` if it was not requested.
fn compared(state: &AppState, cable: &Cable, solved: &CableSolution) -> Option<ComparedReadout> {
    if !bending_query_fits(state) {
        return None;
    }
    let without = |text: &str, more| Some(ComparedReadout { text: text.to_owned(), more, answered: false });
    let found = match &state.analysis.neglected_bending.progress {
        Progress::None => return None,
        Progress::Running(..) => return without("ignored, being compared", String::new()),
        Progress::Failed(why) => return without("ignored", format!(". {why}")),
        Progress::Done(found) => found.iter().find(|b| b.cable == cable.name)?,
    };
    let Some(with) = found.greatest_tension_n else {
        let why = found.unknown.as_ref().map_or_else(|| "not sought".to_owned(), sentence);
        return without("ignored", format!(". No answer was found with it: {why}"));
    };
    let most = extremes::greatest(solved, |n| n.tension_n).map_or(0.0, |(tension, _)| tension);
    let change = if most > 0.0 { format!("{:+.2} %", 100.0 * (with / most - 1.0)) } else { format::force(with) };
    let part = |of: Option<f64>, text: fn(f64) -> String| {
        of.map_or_else(|| "by an unknown amount".to_owned(), |v| format!("by up to {}", text(v)))
    };
    let more = format!(
        ". With it, the greatest tension would be {} ({change}), the forces on supports would change {}, and the shape {}",
        format::force(with),
        part(found.changes.support_force_n, format::force),
        part(found.changes.position_m, format::length),
    );
    Some(ComparedReadout { text: format!("{change} with it"), more, answered: true })
}

/// Error estimate, contacts and friction.
fn accuracy(ui: &mut Ui, solved: &CableSolution, first: &CableSummary) {
    let text = match solved.error_estimate {
        Some(e) if e < ROUNDING_FRACTION => "exact for this model".to_owned(),
        Some(e) if e < format::MIN_RATIO => format::percent(e),
        // Figures of such an answer say its order of magnitude at best: digits would say more.
        Some(e) if e > 1.0 => "more than 100 %".to_owned(),
        Some(e) => format!("± {}", format::percent(e)),
        None => "not estimated".to_owned(),
    };
    figure(
        ui,
        "Error estimate",
        text,
        "Estimated relative error of the greatest tension, of discretisation alone",
        None,
    );
    if !solved.contacts.is_empty() {
        let sliding = solved.contacts.iter().filter(|c| c.state == ContactState::Slip).count();
        let normal_n: f64 = solved.contacts.iter().map(|c| c.normal_n).sum();
        let text = format!("{}, {sliding} sliding", solved.contacts.len());
        figure(ui, "Contacts", text, "Places where the cable touches an obstacle", None);
        figure(ui, "Contact force", format::force(normal_n), "Sum of the normal forces", None);
    }
    if let Some(f) = &first.friction {
        let used_n = if f.used_n.abs() < NEGLIGIBLE_FRICTION_FRACTION * f.available_n.abs() { 0.0 } else { f.used_n };
        let text = format!("{} of {}", format::force(used_n), format::force(f.available_n));
        let help = format!(
            "Friction in use, of all that is available; “{}” uses {} of its share",
            f.obstacle,
            format::percent(f.greatest_ratio)
        );
        figure(ui, "Friction used", text, &help, None);
    }
    // The sum of the forces on a moving cable is no fault: it accelerates the cable.
    let (name, help) = if solved.assumptions.inertia {
        ("Net force", "Sum of all forces on the cable, as a share of the largest: it accelerates the cable")
    } else {
        ("Force imbalance", "Sum of all forces on the cable, as a share of the largest: 0 in perfect balance")
    };
    match &first.balance {
        Some(b) => figure(ui, name, format::percent(b.relative_residual), help, None),
        None => {
            let why = "In a plan view the floor's friction is not among the forces reported, so the balance cannot be checked";
            figure(ui, name, "not known".to_owned(), why, None);
        }
    }
}

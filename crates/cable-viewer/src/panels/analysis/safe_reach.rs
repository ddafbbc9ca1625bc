//! This panel asks where the robot or an end can be taken without passing the service tension, and
//! shows where the cable would snag.

use std::time::Duration;

use cable_core::analysis::safe_reach::area::Area;
use cable_core::analysis::safe_reach::line::{ReachMap, Trip};
use egui::{ComboBox, Slider, Ui};

use crate::command::{Command, ViewCommand};
use crate::jobs::safe_reach::{
    self, PLACES_ACROSS_RANGE, Progress, ReachMaps, ReachSubject, SafeReachOptions, SafeReachState,
};
use crate::state::AppState;
use crate::state::job_questions::reach_target;
use crate::units::format;
use crate::units::unit::Unit;
use crate::widgets::checkbox_and_radio::radio_button;
use crate::widgets::{field, highlight, progress};

/// Width of a slider's value beside it, points.
const SPIN_WIDTH: f32 = 72.0;

/// Between two frames while the time left is counted. Longer: it jumps; shorter: frames that say
/// nothing new.
const COUNTING_REPAINT: Duration = Duration::from_millis(500);

/// Draws it.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.x = 5.0;
    let Some(moved) = reach_target(state) else {
        ui.weak("Nothing in this scene can be moved");
        return;
    };
    let view = &state.analysis.safe_reach;
    let running = match view.progress {
        Progress::Running(share, _) => Some(share),
        _ => None,
    };
    ui.add_enabled_ui(running.is_none(), |ui| choices(ui, state, moved, commands));
    match running {
        Some(share) => progress_and_cancel(ui, view, share, commands),
        None => find_and_clear(ui, view, commands),
    }
    if let Progress::Failed(why) = &view.progress {
        field::fault(ui, &format!("No map: {why}"));
    }
    let Some((maps, scene)) = view.found() else { return };
    both_ways(ui, view.choice, commands);
    if **scene != state.document.scene {
        ui.colored_label(ui.visuals().warn_fg_color, "Out of date: edited since");
    }
    if let Some(share) = view.stopped {
        let text = format!("Incomplete: stopped at {:.0} %", 100.0 * share);
        ui.colored_label(ui.visuals().warn_fg_color, text).on_hover_text("Places not reached yet are not shown");
    }
    for line in describe(maps, view.choice.trip) {
        ui.label(if running.is_some() { so_far(&line) } else { line });
    }
}

/// The progress of a search, with a button that ends it.
fn progress_and_cancel(ui: &mut Ui, view: &SafeReachState, share: f64, commands: &mut Vec<Command>) {
    let bar = progress::bar(ui, share);
    field::name(&bar, "Progress of the safe reach");
    // A place may take a minute without a word: the time left goes on being counted meanwhile.
    ui.ctx().request_repaint_after(COUNTING_REPAINT);
    ui.horizontal(|ui| {
        let help = "Stops the search; what was found stays";
        if ui.button("Cancel safe reach").on_hover_text(help).clicked() {
            commands.push(Command::View(ViewCommand::EndSafeReach));
        }
        if let Some(left_s) = view.remaining_s() {
            ui.weak(time_left(left_s)).on_hover_text("Estimated from the part that is done");
        }
    });
}

/// The buttons that begin a search and take its map away.
fn find_and_clear(ui: &mut Ui, view: &SafeReachState, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let help = "Tests places along the ground, or across the area in view, going there and back from where the cable lies now: \
                    coarsely first, then finer. You can go on working meanwhile. Only the cable's tension counts; the robot \
                    or support itself is assumed to reach every place";
        let find = ui.button("Find safe reach").on_hover_text(help);
        highlight::register(&find, "Find safe reach");
        if find.clicked() {
            commands.push(Command::View(ViewCommand::SearchSafeReach));
        }
        let shown = !matches!(view.progress, Progress::None);
        if ui
            .add_enabled(shown, egui::Button::new("Clear"))
            .on_hover_text("Removes the map")
            .on_disabled_hover_text("There is no map yet")
            .clicked()
        {
            commands.push(Command::View(ViewCommand::EndSafeReach));
        }
    });
}

/// A line about places of which more are to come.
fn so_far(line: &str) -> String {
    let mut letters = line.chars();
    let first = letters.next().map_or_else(String::new, |c| c.to_lowercase().collect());
    format!("So far: {first}{}", letters.as_str())
}

/// What is moved, how finely, and which trip.
fn choices(ui: &mut Ui, state: &AppState, moved: ReachSubject, commands: &mut Vec<Command>) {
    let choice = state.analysis.safe_reach.choice;
    ui.horizontal(|ui| {
        ui.label("Moves");
        let combo = ComboBox::from_id_salt("moved").selected_text(safe_reach::name(&state.document.scene, moved));
        let shown = combo.width(ui.available_width() - 14.0).truncate().show_ui(ui, |ui| {
            for other in safe_reach::movable(&state.document.scene) {
                if ui.selectable_label(other == moved, safe_reach::name(&state.document.scene, other)).clicked() {
                    commands.push(set(SafeReachOptions { moved: Some(other), ..choice }));
                }
            }
        });
        field::name(&shown.response, "What is moved");
        shown
            .response
            .on_hover_text("The robot along its ground, or a support by a hand or a crane through free space");
    });
    if moved != ReachSubject::Robot {
        ui.horizontal(|ui| {
            ui.label("Grid resolution");
            let mut across = choice.across;
            ui.spacing_mut().slider_width = (ui.available_width() - SPIN_WIDTH).max(30.0);
            let slider = ui.add(Slider::new(&mut across, PLACES_ACROSS_RANGE[0]..=PLACES_ACROSS_RANGE[1]));
            field::name(&slider, "Grid resolution");
            let help = "How finely the area in view is tested: twice as many take up to four times as long";
            if slider.on_hover_text(help).changed() {
                commands.push(set(SafeReachOptions { across, ..choice }));
            }
        });
    }
}

/// The choice of the trip.
fn both_ways(ui: &mut Ui, choice: SafeReachOptions, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let there = "The greatest tension with the end at each place";
        let back = "The greatest tension on the way there and back, snags included";
        for (trip, text, help) in [(Trip::There, "There", there), (Trip::ThereAndBack, "There and back", back)] {
            if radio_button(ui, choice.trip == trip, text).on_hover_text(help).clicked() {
                commands.push(set(SafeReachOptions { trip, ..choice }));
            }
        }
    });
}

/// A time left, as roughly as it is known.
fn time_left(seconds: f64) -> String {
    match seconds {
        s if s < 10.0 => "a few seconds left".to_owned(),
        s if s < 90.0 => format!("about {:.0} s left", 10.0 * (s / 10.0).round()),
        s => format!("about {:.0} min left", (s / 60.0).ceil()),
    }
}

fn set(choice: SafeReachOptions) -> Command {
    Command::View(ViewCommand::SetSafeReachOptions(choice))
}

/// A tension that a place is judged by; below that of service it is safe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ReachLimit {
    Service,
    Breaking,
}

impl ReachLimit {
    fn name(self) -> &'static str {
        match self {
            Self::Service => "service",
            Self::Breaking => "breaking",
        }
    }
}

/// The map in words.
#[must_use]
pub fn describe(maps: &ReachMaps, trip: Trip) -> Vec<String> {
    let limits = [ReachLimit::Service, ReachLimit::Breaking].into_iter().zip(maps.limits_n());
    limits
        .map(|(limit, tension_n)| match maps {
            ReachMaps::Line(map) => of_line(map, trip, limit, tension_n),
            ReachMaps::Area(there, _) if trip == Trip::There => of_area(there, limit, tension_n),
            ReachMaps::Area(_, None) => "The way back has not been computed yet".to_owned(),
            ReachMaps::Area(_, Some(ways)) => of_area(ways, limit, tension_n),
        })
        .collect()
}

fn to(x: f64) -> String {
    Unit { decimals: Some(2), ..Unit::M }.text(x)
}

/// Says where along the ground a robot stays below a tension (N).
fn of_line(map: &ReachMap, trip: Trip, limit: ReachLimit, tension_n: f64) -> String {
    let name = limit.name();
    let Some([left, right]) = map.safe_m(tension_n, trip) else {
        return format!("Above {name} tension ({}) at its present position", format::force(tension_n));
    };
    let why = |x: f64, side: f64| {
        let next = map.places.iter().filter(|p| side * (p.at_m[0] - x) > 0.0);
        let next = next.min_by(|a, b| (a.at_m[0] - x).abs().total_cmp(&(b.at_m[0] - x).abs()));
        match next.map(|p| (p.jammed, p.tension_n(trip))) {
            None => "",
            Some((true, _)) => " (farther, the robot runs into its cable)",
            Some((_, n)) if n.is_nan() => " (farther, no solution found)",
            Some((_, n)) if n.is_infinite() => " (farther, the cable is too short)",
            Some(_) => "",
        }
    };
    let from = match limit {
        ReachLimit::Service => "Safe from",
        ReachLimit::Breaking => "Unbroken from",
    };
    format!("{from} x = {}{} to {}{}", to(left), why(left, -1.0), to(right), why(right, 1.0))
}

/// Says where in the area an end stays below a tension (N).
fn of_area(area: &Area, limit: ReachLimit, tension_n: f64) -> String {
    let name = limit.name();
    let force = format::force(tension_n);
    match area.below(tension_n) {
        Some((_, [low, high])) => format!(
            "Below {name} tension ({force}) in the area drawn: x from {} to {}, y from {} to {}",
            to(low[0]),
            to(high[0]),
            to(low[1]),
            to(high[1])
        ),
        None => format!("Nowhere below {name} tension ({force})"),
    }
}

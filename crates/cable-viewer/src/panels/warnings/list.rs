//! The panel of warnings says what is wrong, where, why, what it does to the result, and offers the
//! fix where one change is one.

use cable_core::scene::SupportKind;
use cable_core::solution::{Warning, WarningCause, WarningKind};
use cable_core::{Settings, Solution};
use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Atom, Button, Color32, Layout, RichText, ScrollArea, TextStyle, Ui, vec2};

use crate::command::scene::is_refused_pull;
use crate::command::{Command, FileCommand, PlaybackCommand, SceneCommand, ViewCommand};
use crate::panels::display_names::capital;
use crate::panels::quality;
use crate::panels::scene_errors::{self, Fix};
use crate::panels::warnings::figures::{figures, short_title};
use crate::state::{AppState, Item, NoAnswer, OpenPanels, WorkerStatus};
use crate::units::sentence::sentence;
use crate::units::{format, unit};
use crate::widgets::field;
use crate::widgets::icon::{self, Icon};
use crate::worker::engine::is_quasi_static;

/// Most warnings drawn; the rest is counted. A cable that is too tight everywhere can have one a
/// node.
const MAX_ROWS: usize = 30;

/// Most of the window's height that warnings take; more of them scroll. More: the readouts below
/// are out of sight when something is wrong; less: a second warning is.
const SHARE: f32 = 0.42;

/// The severity of something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Severity {
    /// The result does not hold, or the cable breaks.
    Stop,
    /// The result holds and the cable does not like it.
    Caution,
    /// Worth knowing.
    Note,
}

/// One entry of the list.
struct WarningRow {
    severity: Severity,
    /// It is about what the cable carries, which comes first among equals.
    of_tension: bool,
    /// Its subject, as long as it lasts; figures are in the title.
    kind: String,
    title: String,
    /// The title in three parts: what, its figures, and its place, which is never cut.
    parts: Option<[String; 3]>,
    text: String,
    /// The place to look at, m.
    at_m: Option<[f64; 2]>,
    /// The thing to pick.
    item: Option<Item>,
    fixes: Vec<Fix>,
    /// The reason why a fix would change nothing.
    no_use: Option<&'static str>,
}

/// Draws all but the worst, which stands above everything that scrolls.
pub fn ui(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let entries = entries(state);
    let high = SHARE * ui.ctx().content_rect().height();
    let area = ScrollArea::vertical().id_salt("warnings").max_height(high).min_scrolled_height(high);
    area.auto_shrink([false, true]).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        for (k, entry) in entries.iter().enumerate().take(MAX_ROWS).skip(1) {
            row(ui, k, entry, commands);
        }
        if entries.len() > MAX_ROWS {
            ui.weak(format!("and {} more", entries.len() - MAX_ROWS));
        }
        if seeks(state) {
            seeking(ui);
        }
    });
}

/// Returns whether there is more to say than what [`worst`] says.
pub fn has_more(state: &AppState) -> bool {
    let count = entries(state).len();
    count > 1 || (count == 1 && seeks(state))
}

/// The worst, as a line, or that there is none, in as much room: what lies below does not move as
/// warnings come and go. Its words stand below it once they are asked for.
pub fn worst(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let entries = entries(state);
    if let Some(entry) = entries.first() {
        let high = SHARE * ui.ctx().content_rect().height();
        let area = ScrollArea::vertical().id_salt("worst warning").max_height(high).min_scrolled_height(high);
        area.auto_shrink([false, true]).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            row(ui, 0, entry, commands);
        });
        return;
    }
    ui.horizontal(|ui| {
        if seeks(state) {
            seeking(ui);
        } else if state.is_current() {
            icon::sign(ui, Icon::Check, ui.visuals().text_color());
            ui.weak("No warnings");
        } else {
            ui.weak("Warnings follow once this is solved");
        }
    });
}

/// The worst where no panel says it, cut at a width (points).
pub fn worst_in_strip(ui: &mut Ui, width: f32, state: &AppState, commands: &mut Vec<Command>) {
    let entries = entries(state);
    let Some(worst) = entries.first() else { return };
    let (colour, sign) = look(ui, worst.severity);
    let room = vec2(width, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(room, Layout::right_to_left(Align::Center), |ui| {
        let line = ui.add(button(ui, worst));
        field::name(&line, "Worst warning");
        let more = if entries.len() > 1 { format!("\n\nand {} more", entries.len() - 1) } else { String::new() };
        if line.on_hover_text(format!("{}{more}", worst.text)).clicked() {
            show(worst, commands);
        }
        icon::sign(ui, sign, colour);
    });
}

/// Returns whether it is still sought if the rest is the only one; a cable that touches nothing
/// remembers none.
fn seeks(state: &AppState) -> bool {
    let touches = |answer: &Solution| answer.cables.iter().any(|c| !c.contacts.is_empty());
    let answer = state.live.snapshot.solution.as_deref().filter(|_| state.live.snapshot.seeks_histories);
    state.is_current() && answer.is_some_and(touches)
}

fn seeking(ui: &mut Ui) {
    ui.weak("Looking for other resting places…")
        .on_hover_text("The figures hold for the shape shown; friction may allow others, which are being sought");
}

/// The number of warnings, as a row that leads to the worst.
pub fn summary(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let entries = entries(state);
    let Some(worst) = entries.first() else { return };
    let (colour, sign) = look(ui, worst.severity);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        icon::sign(ui, sign, colour);
        let text = count(&entries);
        let row = ui.add(Button::selectable(false, text));
        if row.on_hover_text(format!("The first: {}. Click: zooms on it", worst.title)).clicked() {
            show(worst, commands);
            commands.push(Command::View(ViewCommand::ShowPanels(OpenPanels { results: true, ..state.ui.panels })));
        }
    });
}

/// “2 warnings, 1 note”: a note asks nothing of anyone.
fn count(entries: &[WarningRow]) -> String {
    let notes = entries.iter().filter(|e| e.severity == Severity::Note).count();
    let counted = [(entries.len() - notes, "warning"), (notes, "note")];
    let named = counted.into_iter().filter(|(n, _)| *n > 0);
    let words: Vec<String> = named.map(|(n, word)| format!("{n} {word}{}", if n == 1 { "" } else { "s" })).collect();
    words.join(", ")
}

/// Their titles with their number, and what leads to the place of each or to their list.
pub fn places(state: &AppState) -> Vec<(String, Command)> {
    let list = || ViewCommand::ShowPanels(OpenPanels { results: true, ..state.ui.panels });
    let named = entries(state).into_iter().enumerate().map(|(k, e)| {
        let command = e.at_m.map_or_else(list, ViewCommand::ZoomOn);
        (format!("warning {}: {}", k + 1, e.title), Command::View(command))
    });
    named.collect()
}

/// All rows, the most severe first.
fn entries(state: &AppState) -> Vec<WarningRow> {
    let mut list = Vec::new();
    list.extend(dead_worker(state));
    list.extend(scene_fault(state));
    if let (Some(error), None) = (&state.live.snapshot.error, &state.document.fault) {
        let cancelled = *error == NoAnswer::Cancelled;
        let error = capital(sentence(error).trim_end_matches('.'));
        let text = format!("{error}. The picture and the figures are of the last scene that was solved.");
        let solve = Fix { label: "Solve".to_owned(), command: Command::Playback(PlaybackCommand::Solve) };
        let (title, fixes) = if cancelled { ("Not solved", vec![solve]) } else { ("No answer", Vec::new()) };
        list.push(WarningRow { title: title.to_owned(), fixes, ..entry(Severity::Stop, text) });
    }
    // Warnings of a draft or of another scene's answer say nothing of this one.
    if let Some(answer) = state.live.snapshot.solution.as_deref().filter(|_| state.is_current()) {
        list.extend(answer.warnings.iter().map(|w| of_warning(state, answer, w)));
        list.extend(quality::problems(state, answer).into_iter().map(of_problem));
    }
    // A stable sort: equals stay in the order of the answer.
    list.sort_by_key(|e| (e.severity, !e.of_tension));
    list
}

/// A row of a severity with this text and nothing else.
fn entry(severity: Severity, text: String) -> WarningRow {
    WarningRow {
        severity,
        of_tension: false,
        kind: String::new(),
        title: String::new(),
        parts: None,
        text,
        at_m: None,
        item: None,
        fixes: Vec::new(),
        no_use: None,
    }
}

fn dead_worker(state: &AppState) -> Option<WarningRow> {
    let WorkerStatus::Dead(words) = &state.solver.status else { return None };
    let fix = Fix { label: "Restart the solver".to_owned(), command: Command::File(FileCommand::RestartWorker) };
    let text =
        format!("{}. The scene is safe; nothing is solved until it runs again.", capital(words.trim_end_matches('.')));
    Some(WarningRow { title: "The solver stopped".to_owned(), fixes: vec![fix], ..entry(Severity::Stop, text) })
}

/// The row of a scene that cannot be solved.
fn scene_fault(state: &AppState) -> Option<WarningRow> {
    let found = scene_errors::summary(state)?;
    let text = format!("{found}. The picture and the figures are of the last scene that could be solved.");
    let title = "The scene cannot be solved".to_owned();
    let pull = is_refused_pull(state) && !is_quasi_static(state.solver.model);
    let pull = pull.then(|| Fix {
        label: "Allow pulling beyond the cable's length".to_owned(),
        command: Command::Playback(PlaybackCommand::PullPastLength(true)),
    });
    let fixes = scene_errors::fix(state).into_iter().chain(pull).collect();
    Some(WarningRow { title, fixes, ..entry(Severity::Stop, text) })
}

/// How grave a warning is, and the few words that name it.
fn severity_and_title(warning: &Warning) -> (Severity, &'static str) {
    match warning.kind {
        WarningKind::BreakingTension if matches!(warning.cause, WarningCause::AboveBreakingAfterBreak { .. }) => {
            (Severity::Stop, "May break again")
        }
        WarningKind::BreakingTension => (Severity::Stop, "Breaks here"),
        WarningKind::Broken => (Severity::Stop, "Broken"),
        WarningKind::MayBreak => (Severity::Caution, "May break"),
        WarningKind::Kink => (Severity::Caution, "Kinked"),
        WarningKind::SidewallPressure => (Severity::Caution, "Sidewall pressure too high"),
        WarningKind::Loop => (Severity::Caution, "Crosses itself"),
        WarningKind::Curl => (Severity::Caution, "Tight curl"),
        WarningKind::Wrapped => (Severity::Caution, "Wrapped round an obstacle"),
        WarningKind::Snag => (Severity::Caution, "Snagged"),
        WarningKind::Slack => (Severity::Note, "Slack"),
        WarningKind::ServiceTension => (Severity::Caution, "Above service tension"),
        WarningKind::BendRadius => (Severity::Caution, "Bend too tight"),
        WarningKind::Accuracy => (Severity::Caution, "Accuracy below target"),
        // A quick hand, or a cable that holds against it: nothing is in its way.
        WarningKind::SupportHeld
            if matches!(warning.cause, WarningCause::Lags { .. } | WarningCause::HandLags { .. }) =>
        {
            (Severity::Note, "Support lags behind")
        }
        WarningKind::SupportHeld => (Severity::Caution, "Support blocked"),
        WarningKind::InitialPenetration => (Severity::Note, "Moved out of an obstacle"),
        WarningKind::ClearOfWheel => (Severity::Note, "Clear of a wheel"),
        WarningKind::ThroughRobot => (Severity::Caution, "Lies through the robot"),
        WarningKind::RobotInObstacle => (Severity::Caution, "Robot in an obstacle"),
        WarningKind::Stabilised => (Severity::Caution, "Motion was stabilised"),
        WarningKind::EnergyGrows => (Severity::Stop, "Energy error"),
        WarningKind::NotUnique => (Severity::Note, "Depends on how it was laid"),
        _ => (Severity::Caution, "Warning"),
    }
}

/// The row of a warning.
fn of_warning(state: &AppState, answer: &Solution, warning: &Warning) -> WarningRow {
    let (severity, title) = severity_and_title(warning);
    let index = state.document.scene.cables.iter().position(|c| c.name == warning.cable);
    let since = warning.since_s.map_or_else(String::new, |t| format!(", since {t:.2}\u{a0}s"));
    let along = unit::Unit { decimals: Some(2), ..unit::Unit::M }.text(warning.arc_length_m);
    // The name only where there is a choice.
    let of = if answer.cables.len() > 1 { format!(" of {}", warning.cable) } else { String::new() };
    let figures = figures(warning);
    let words = figures.as_ref().map_or_else(String::new, |f| format!(": {}", f.words));
    let along = along.replace(' ', "\u{a0}");
    // All of the cable has one shape of several: there is no place to it.
    let everywhere = warning.kind == WarningKind::NotUnique;
    let at = if everywhere { String::new() } else { format!(" at {along}") };
    let whole = format!("{title}{at}{of}{words}{since}");
    WarningRow {
        severity,
        of_tension: matches!(
            warning.kind,
            WarningKind::Broken | WarningKind::BreakingTension | WarningKind::MayBreak | WarningKind::ServiceTension
        ),
        kind: format!("{title} {}", warning.cable),
        parts: Some([
            short_title(warning.kind, title).to_owned(),
            figures.map_or_else(String::new, |f| f.short) + &of,
            if everywhere { String::new() } else { along },
        ]),
        title: whole,
        text: warning.since_s.map_or_else(
            || sentence(warning),
            |t| format!("{} (since {t:.2}\u{a0}s)", sentence(warning).trim_end_matches('.')),
        ),
        at_m: position(answer, warning).filter(|_| !everywhere),
        item: index.map(Item::Cable),
        fixes: remedy(state, answer, warning, index).into_iter().collect(),
        no_use: (everywhere && !can_be_laid_anew(state, index)).then_some(LIES_AS_LAID),
    }
}

/// The entry of a reason to doubt the figures, of which the form of the solver shows more.
fn of_problem(problem: quality::QualityProblem) -> WarningRow {
    let quality::QualityProblem { title, figure, why } = problem;
    WarningRow {
        kind: title.to_owned(),
        title: format!("{title}: {figure}"),
        parts: Some([title.to_owned(), figure, String::new()]),
        item: Some(Item::Solver),
        ..entry(Severity::Caution, format!("{why}. Select Solver in the outline for details."))
    }
}

/// The place of a warning (m).
fn position(answer: &Solution, warning: &Warning) -> Option<[f64; 2]> {
    if warning.at_m.is_some() {
        return warning.at_m;
    }
    let cable = answer.cables.iter().find(|c| c.name == warning.cable)?;
    let distance = |s: f64| (s - warning.arc_length_m).abs();
    let nearest = cable.nodes.iter().min_by(|a, b| distance(a.arc_length_m).total_cmp(&distance(b.arc_length_m)))?;
    Some([nearest.x_m, nearest.y_m])
}

/// Said of a cable that laying anew would leave where it is.
const LIES_AS_LAID: &str = "It already lies as laid from its supports: it has no route, and no time has run";

/// Returns whether a cable lies otherwise than laid from its supports: led by a route, or moved
/// since.
fn can_be_laid_anew(state: &AppState, cable: Option<usize>) -> bool {
    let of = cable.and_then(|k| state.document.scene.cables.get(k));
    of.is_some_and(|c| !c.route_m.is_empty()) || state.live.snapshot.solution.as_ref().is_some_and(|s| s.time_s > 0.0)
}

/// One change that takes the warning's cause away, where there is one.
fn remedy(state: &AppState, answer: &Solution, warning: &Warning, index: Option<usize>) -> Option<Fix> {
    match warning.kind {
        // A finer mesh does not bring robot and cable together.
        WarningKind::Accuracy if matches!(warning.cause, WarningCause::RobotOutOfBalance { .. }) => None,
        WarningKind::Accuracy => {
            let nodes = answer.cables.iter().map(|c| c.nodes.len()).max()?;
            let segments = 2 * nodes.saturating_sub(1).max(1);
            let settings = Settings { segments: Some(segments), ..state.solver.settings };
            Some(Fix { label: format!("Use {segments} segments"), command: Command::SetSettings(settings) })
        }
        WarningKind::BendRadius => wheel(state, answer, warning, index?),
        WarningKind::NotUnique => {
            let command = Command::Scene(SceneCommand::LayAnew { cable: index? });
            Some(Fix { label: "Lay again".to_owned(), command })
        }
        _ => None,
    }
}

/// A bend at a pulley whose wheel is too small: a wheel as large as the cable needs.
fn wheel(state: &AppState, answer: &Solution, warning: &Warning, cable: usize) -> Option<Fix> {
    let of = state.document.scene.cables.get(cable)?;
    let solved = answer.cables.get(cable)?;
    // The bend of a wheel lies within a wheel's radius of where the cable leaves it.
    let near = |s: f64| (s - warning.arc_length_m).abs() <= of.min_bend_radius_m;
    let support = of.supports.iter().zip(&solved.supports).position(|(s, r)| {
        s.kind == SupportKind::Pulley && s.radius_m.unwrap_or(0.0) < of.min_bend_radius_m && near(r.arc_length_m)
    })?;
    let mut value = of.supports.get(support)?.clone();
    value.radius_m = Some(of.min_bend_radius_m);
    let label = format!("Give {} a wheel of {}", value.name, format::length(of.min_bend_radius_m));
    let command = SceneCommand::SetSupport { cable, support, value: Box::new(value) };
    Some(Fix { label, command: Command::Scene(command) })
}

/// One line: severity, what, value of limit, and the place at its end, which is never cut. A click
/// on it shows the place; the text and the fix are behind the sign at its end, and the text is told
/// on hover.
fn row(ui: &mut Ui, number: usize, entry: &WarningRow, commands: &mut Vec<Command>) {
    let (colour, sign) = look(ui, entry.severity);
    // Remembered by what it says: the next warning in its place is another one. Where there is no
    // answer at all, the words are open from the start.
    let id = ui.scope_id().with((entry.severity as u8, &entry.kind));
    let mut open = ui.data(|d| d.get_temp(id)).unwrap_or(entry.parts.is_none());
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        icon::sign(ui, sign, colour);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let arrow = ui.add(Button::new(if open { "−" } else { "+" }).small().min_size(vec2(16.0, 0.0)));
            field::name(&arrow, &format!("Details of warning {}", number + 1));
            if arrow.on_hover_text("What it means, and what can be done").clicked() {
                open = !open;
                ui.data_mut(|d| d.insert_temp(id, open));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let line = ui.add(button(ui, entry).min_size(vec2(ui.available_width(), 0.0)));
                field::name(&line, &entry.title);
                let help = match entry.at_m {
                    Some(at_m) => format!("{}\n\nClick: zooms on {}", entry.text, format::position(at_m)),
                    None => entry.text.clone(),
                };
                if line.on_hover_text(help).clicked() {
                    show(entry, commands);
                }
            });
        });
    });
    if open {
        ui.indent(id, |ui| {
            ui.add(egui::Label::new(&entry.text).wrap());
            if entry.at_m.is_some() || !entry.fixes.is_empty() {
                ui.horizontal_wrapped(|ui| actions(ui, number, entry, commands));
            }
        });
    }
}

fn look(ui: &Ui, severity: Severity) -> (Color32, Icon) {
    match severity {
        Severity::Stop => (ui.visuals().error_fg_color, Icon::Stop),
        Severity::Caution => (ui.visuals().warn_fg_color, Icon::Caution),
        Severity::Note => (ui.visuals().weak_text_color.unwrap_or(Color32::GRAY), Icon::Note),
    }
}

/// Returns the line of an entry: what gives way where there is no room is not the place.
fn button<'a>(ui: &Ui, entry: &WarningRow) -> Button<'a> {
    let place = entry.parts.as_ref().map_or("", |[.., place]| place);
    let button = if place.is_empty() {
        Button::new((line(ui, entry), Atom::grow()))
    } else {
        let place = RichText::new(place).text_style(TextStyle::Small).color(ui.visuals().text_color());
        Button::new((line(ui, entry), Atom::grow(), place))
    };
    button.frame(false).truncate()
}

/// Returns what it is, and smaller its figures.
fn line(ui: &Ui, entry: &WarningRow) -> LayoutJob {
    let mut job = LayoutJob::default();
    let mut push = |text: &str, style: TextStyle, colour: Color32| {
        let font = style.resolve(ui.style());
        job.append(
            text,
            0.0,
            TextFormat { font_id: font, color: colour, valign: Align::Center, ..TextFormat::default() },
        );
    };
    let [what, rest] = entry.parts.as_ref().map_or([entry.title.as_str(), ""], |[what, rest, _]| [what, rest]);
    push(what, TextStyle::Body, ui.visuals().strong_text_color());
    if !rest.is_empty() {
        push(&format!(" {rest}"), TextStyle::Small, ui.visuals().text_color());
    }
    job
}

/// Zooms on where it is and picks what it is about.
fn show(entry: &WarningRow, commands: &mut Vec<Command>) {
    if let Some(at_m) = entry.at_m {
        commands.push(Command::View(ViewCommand::ZoomOn(at_m)));
    }
    // An entry without a place has a form, or nothing to show.
    if entry.item.is_some() && (entry.at_m.is_some() || entry.item == Some(Item::Solver)) {
        commands.push(Command::View(ViewCommand::Select(entry.item)));
    }
}

/// The buttons of a row.
fn actions(ui: &mut Ui, number: usize, entry: &WarningRow, commands: &mut Vec<Command>) {
    if let Some(at_m) = entry.at_m {
        let button = ui.button("Show").on_hover_text(format!("Zooms on {}", format::position(at_m)));
        field::name(&button, &format!("Show warning {}", number + 1));
        if button.clicked() {
            show(entry, commands);
        }
    }
    for fix in &entry.fixes {
        let button = ui.add_enabled(entry.no_use.is_none(), Button::new(&fix.label));
        let help = match fix.command {
            Command::Scene(SceneCommand::LayAnew { .. }) => {
                "Drops its route and lays it from its supports again, back at the start; undo reverts this"
            }
            Command::Playback(PlaybackCommand::PullPastLength(_)) => {
                "Undoes the move. From now on, a support dragged beyond the cable's length is pulled by a spring until the cable breaks: press Play and drag again"
            }
            _ => "Corrects this; undo reverts it",
        };
        if button.on_hover_text(help).on_disabled_hover_text(entry.no_use.unwrap_or_default()).clicked() {
            commands.push(fix.command.clone());
            if matches!(fix.command, Command::Scene(_)) {
                commands.push(Command::Scene(SceneCommand::EditDone));
            }
        }
    }
}

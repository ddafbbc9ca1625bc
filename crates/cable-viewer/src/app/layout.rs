//! The layout says where panels and canvas are.

use egui::style::ScrollAnimation;
use egui::{CentralPanel, CollapsingHeader, Frame, Id, Panel, Rect, ScrollArea, Ui, UiBuilder, vec2};

use crate::app::guidance::{first_step_hints, tutorial_bar};
use crate::app::menu;
use crate::canvas::layers::{legend, safe_reach};
use crate::command::Command;
use crate::panels::playback::Rail;
use crate::state::{AppState, ToolSection};
use crate::widgets::{focus, highlight};
use crate::{canvas, panels};

type PanelUi = fn(&mut Ui, &AppState, &mut Vec<Command>);

/// A part of a panel under a heading that folds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    Outline,
    Selected,
    Warnings,
    MarkedPlace,
    Readouts,
    SafeReach,
    Compare,
    UnmarkedPlace,
    FrictionRange,
}

impl Section {
    fn title(self) -> &'static str {
        match self {
            Self::Outline => "Outline",
            Self::Selected => "Selected",
            Self::Warnings => "Warnings",
            Self::MarkedPlace => "Tension at the marked place",
            Self::Readouts => "Readouts",
            Self::SafeReach => "Safe reach",
            Self::Compare => "Compare",
            Self::UnmarkedPlace => "Tension at a place",
            Self::FrictionRange => "Friction range",
        }
    }

    /// The section in which a tool is answered.
    fn of_tool(tool: ToolSection) -> Self {
        match tool {
            ToolSection::MarkedPlace => Self::MarkedPlace,
            ToolSection::Readouts => Self::Readouts,
            ToolSection::SafeReach => Self::SafeReach,
            ToolSection::Compare => Self::Compare,
            ToolSection::FrictionRange => Self::FrictionRange,
            ToolSection::Solver => Self::Selected,
        }
    }

    /// The contents. Where there is a panel on the right, the head of the readouts stands above
    /// what scrolls there.
    fn panel(self, state: &AppState) -> PanelUi {
        match self {
            Self::Outline => panels::scene::outline::ui,
            Self::Selected => panels::selected_item::ui,
            Self::Warnings => panels::warnings::ui,
            Self::MarkedPlace | Self::UnmarkedPlace => panels::analysis::tension_budget::ui,
            Self::Readouts if state.ui.results_beside => panels::readouts::below_headline,
            Self::Readouts => panels::readouts::ui,
            Self::SafeReach => panels::analysis::safe_reach::ui,
            Self::Compare => panels::analysis::compare::ui,
            Self::FrictionRange => panels::analysis::friction_range::ui,
        }
    }
}

/// A list of sections that scrolls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SectionColumn {
    /// The outline of the scene, and in a small window the form of the selected thing.
    Edit,
    /// Draws all warnings except the worst, the form of the selected item, then the readouts. If a
    /// place on the cable is marked, its tension stands above the readouts, otherwise at the end.
    Results,
}

impl SectionColumn {
    fn id(self) -> &'static str {
        match self {
            Self::Edit => "edit",
            Self::Results => "read",
        }
    }

    fn sections(self) -> &'static [Section] {
        match self {
            Self::Edit => &[Section::Outline, Section::Selected],
            Self::Results => &[
                Section::Warnings,
                Section::Selected,
                Section::MarkedPlace,
                Section::Readouts,
                Section::SafeReach,
                Section::Compare,
                Section::UnmarkedPlace,
                Section::FrictionRange,
            ],
        }
    }
}

/// Room for the bar beside what scrolls, points.
const SCROLL_BAR_WIDTH: f32 = 6.0;
/// Narrower windows (points) have one side panel instead of two: the canvas would be smaller than
/// its labels.
const MIN_TWO_PANELS_WIDTH: f32 = 1000.0;
/// Lower windows (points) have one side panel, and the graphs in it: nothing would be left of the
/// canvas above them.
const MIN_GRAPHS_WINDOW_HEIGHT: f32 = 520.0;
/// Width of the outline as a fraction of the window's width, and its least and greatest width,
/// points: the content of the panels never moves the canvas. If it were wider, the canvas would
/// have less than 60 % of 1280×800; if it were narrower, the kind of an item would not fit beside
/// its name.
const OUTLINE_WIDTH: WindowShare = WindowShare { fraction: 0.142, least: 164.0, most: 250.0 };
/// As [`OUTLINE_WIDTH`], of the panel on the right; narrower: a name, a number and its unit do not
/// fit in a line.
const INSPECTOR_WIDTH: WindowShare = WindowShare { fraction: 0.2, least: 250.0, most: 340.0 };
/// Widest legend above the canvas, points: beyond, colours are no better told apart.
const LEGEND_WIDTH: f32 = 340.0;
/// Widest warning above the canvas, points.
const WARNING_WIDTH: f32 = 300.0;
/// Height of the graphs with the timeline as a part of the window's, and the least, points. Less:
/// lines are not read in them; more: the canvas has less than 48 % of 1280×800.
const GRAPHS_HEIGHT: (f32, f32) = (0.205, 150.0);
/// Height of the row of playback in the first frame, points; later ones use that of the one before.
const PLAYBACK_HEIGHT: f32 = 26.0;

/// A size as a part of the window's, within limits (points).
#[derive(Clone, Copy, Debug)]
struct WindowShare {
    fraction: f32,
    least: f32,
    most: f32,
}

impl WindowShare {
    fn of(self, window: f32) -> f32 {
        (self.fraction * window).clamp(self.least, self.most).round()
    }
}

/// Draws everything but dialogs. Only the canvas needs the state mutable: it fits the camera to its
/// own size.
pub fn ui(ui: &mut Ui, state: &mut AppState, commands: &mut Vec<Command>) {
    highlight::set_target(ui.ctx(), tutorial_bar::points_at(state));
    let [width, height] = ui.ctx().content_rect().size().into();
    let graphs_below = height >= MIN_GRAPHS_WINDOW_HEIGHT;
    let open = state.ui.panels;
    let wide = width >= MIN_TWO_PANELS_WIDTH && graphs_below;
    // The worst warning stands above what scrolls in a panel, or else in the strip above the
    // canvas.
    let told_in_panel = if wide { open.results } else { open.edit || open.results };
    bars_at_the_top(ui, state, commands);
    state.ui.results_beside = wide && open.results;
    // The keyboard goes through panels in the order in which they are drawn. They are drawn as they
    // are read, from the left to the right and down; those at the lower edge, which come last, keep
    // the height that they had in the frame before.
    let below_menu = ui.available_rect_before_wrap();
    let playback_height = HeightKept::of(ui, "playback", PLAYBACK_HEIGHT);
    let mut main = child(ui, "main", below_menu.with_max_y(below_menu.max.y - playback_height.points));
    if !wide && (open.edit || open.results) {
        let graphs_tab = if graphs_below { GraphsTab::None } else { GraphsTab::Shown };
        tabs(&mut main, state, graphs_tab, commands);
    }
    let main = main.available_rect_before_wrap();
    let inspector_width = if state.ui.results_beside { INSPECTOR_WIDTH.of(width) } else { 0.0 };
    let beside_inspector = main.with_max_x(main.max.x - inspector_width);
    let graphs_height = (GRAPHS_HEIGHT.0 * height).max(GRAPHS_HEIGHT.1).round();
    let shown_graphs_height = (graphs_below && open.graphs).then_some(graphs_height);
    let drawer = drawer_below(ui, state, shown_graphs_height);
    let rail = if wide && !open.graphs { Rail::Here } else { Rail::Elsewhere };
    let drawer_height = drawer.as_ref().map_or(0.0, |drawer| drawer.points);
    let mut picture = child(ui, "picture", beside_inspector.with_max_y(beside_inspector.max.y - drawer_height));
    if wide && open.edit {
        let outline = Panel::left("edit");
        side(&mut picture, outline, OUTLINE_WIDTH.of(width), |ui| scroll(ui, SectionColumn::Edit, state, commands));
    }
    if !told_in_panel {
        strip_above(&mut picture, state, commands);
    }
    canvas_with_hints(&mut picture, state, commands);
    if state.ui.results_beside {
        side(&mut child(ui, "inspector", main), Panel::right("read"), inspector_width, |ui| {
            inspector(ui, state, commands);
        });
    }
    // Below outline and canvas, and so wider than the canvas.
    if let Some(open_drawer) = drawer {
        let mut below = child(ui, "below", beside_inspector);
        let height = match open_drawer.name {
            "plots" => graphs(&mut below, graphs_height, state, commands),
            _ => timeline(&mut below, state, rail, commands),
        };
        open_drawer.keep(ui, height);
    }
    let mut foot = child(ui, "foot", below_menu);
    let drawn = Panel::bottom("playback").show(&mut foot, |ui| panels::playback::with_rail(ui, state, rail, commands));
    playback_height.keep(ui, drawn.response.rect.height());
    highlight::frame(ui.ctx());
    focus::frame(ui.ctx());
}

/// The menu, and the step of a tutorial.
fn bars_at_the_top(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    Panel::top("menu").show(ui, |ui| menu::ui(ui, state, commands));
    if state.ui.tutorial.is_some() {
        Panel::top("guide").show(ui, |ui| tutorial_bar::strip(ui, state, commands));
    }
}

/// The height kept for what is drawn below the canvas: graphs of a usual height (points), if they
/// are shown, else the timeline of a past that is shown, which must not be forgotten about.
fn drawer_below(ui: &Ui, state: &AppState, graphs_height: Option<f32>) -> Option<HeightKept> {
    let past = state.live.recording.shown_s.is_some();
    let graphs = graphs_height.map(|usual| ("plots", usual));
    let drawer = graphs.or_else(|| past.then_some(("timeline", PLAYBACK_HEIGHT)));
    drawer.map(|(name, usual)| HeightKept::of(ui, name, usual))
}

/// The canvas, with what is offered on it.
fn canvas_with_hints(picture: &mut Ui, state: &mut AppState, commands: &mut Vec<Command>) {
    let canvas = CentralPanel::no_frame().frame(Frame::NONE);
    let canvas = canvas.show(picture, |ui| canvas::ui(ui, state, commands)).response.rect;
    canvas::follow::offer(picture, canvas, state, commands);
    first_step_hints::ui(picture, canvas, state, commands);
}

/// The panel on the right.
fn inspector(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    legend::beside(ui, state);
    safe_reach::legend_beside(ui, state);
    panels::readouts::head(ui, state, commands);
    panels::warnings::worst(ui, state, commands);
    ui.separator();
    scroll(ui, SectionColumn::Results, state, commands);
}

/// Draws the graphs, with the timeline, at the foot of a part of the window, at first in a height
/// (points). Returns the height that they take.
fn graphs(below: &mut Ui, height: f32, state: &AppState, commands: &mut Vec<Command>) -> f32 {
    let frame = Frame::side_top_panel(below.style()).inner_margin(egui::Margin::symmetric(5, 2));
    let drawer = Panel::bottom("plots").frame(frame).resizable(true).default_size(height);
    let drawn = drawer.size_range(GRAPHS_HEIGHT.1..=500.0).show(below, |ui| {
        // A panel takes the height of what is in it: without this it shrinks by a margin a frame.
        ui.set_min_height(ui.available_height());
        panels::plots::ui(ui, state, commands);
    });
    drawn.response.rect.height()
}

/// Draws the timeline alone there, or what of it is not in the row of playback, and returns its
/// height.
fn timeline(below: &mut Ui, state: &AppState, rail: Rail, commands: &mut Vec<Command>) -> f32 {
    let drawn = Panel::bottom("timeline").show(below, |ui| match rail {
        Rail::Elsewhere => panels::timeline::ui(ui, state, commands),
        Rail::Here => {
            ui.horizontal(|ui| panels::timeline::buttons(ui, state, commands));
        }
    });
    drawn.response.rect.height()
}

/// A part of the window by itself.
fn child(ui: &mut Ui, name: &str, part: Rect) -> Ui {
    ui.new_child(UiBuilder::new().id_salt(name).max_rect(part))
}

/// The height of a panel that is drawn after what stands above it, in the frame before.
struct HeightKept {
    name: &'static str,
    points: f32,
}

impl HeightKept {
    /// Before the first frame it is the `usual` one, points.
    fn of(ui: &Ui, name: &'static str, usual: f32) -> Self {
        Self { name, points: ui.data(|d| d.get_temp(Id::unique(("height", name)))).unwrap_or(usual) }
    }

    /// Keeps the height for the next frame, which follows at once if it is another.
    fn keep(self, ui: &Ui, height: f32) {
        ui.data_mut(|d| d.insert_temp(Id::unique(("height", self.name)), height));
        if height != self.points {
            ui.ctx().request_repaint();
        }
    }
}

/// The meaning of the colours and the worst warning, in a strip above the canvas: on it they would
/// lie over the handles of things.
fn strip_above(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    let has_map = state.analysis.safe_reach.found().is_some();
    let height = if has_map { safe_reach::KEY_HEIGHT } else { legend::STRIP_HEIGHT };
    let margin = egui::Margin::symmetric(8, 2);
    let frame = Frame::side_top_panel(ui.style()).inner_margin(margin);
    let strip = Panel::top("legends").frame(frame).resizable(false).exact_size(height + margin.sum().y);
    strip.show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let legends: &[fn(&mut Ui, &AppState)] =
                if has_map { &[legend::beside, safe_reach::legend_beside] } else { &[legend::beside] };
            let parts = (legends.len() + 1) as f32;
            let width = (ui.available_width() / parts - ui.spacing().item_spacing.x).min(LEGEND_WIDTH);
            for legend in legends {
                ui.allocate_ui(vec2(width, height), |ui| legend(ui, state));
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::TOP), |ui| {
                panels::warnings::worst_in_strip(ui, ui.available_width().min(WARNING_WIDTH), state, commands);
            });
        });
    });
}

/// A side panel of a width that its contents do not change.
fn side(ui: &mut Ui, panel: Panel, width: f32, contents: impl FnOnce(&mut Ui)) {
    let frame = Frame::side_top_panel(ui.style()).inner_margin(egui::Margin::symmetric(5, 2));
    panel.frame(frame).resizable(false).exact_size(width).show(ui, |ui| {
        ui.set_max_width(ui.available_width());
        contents(ui);
    });
}

/// The contents of the one panel of a small window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Tab {
    #[default]
    Edit,
    Read,
    Graphs,
}

/// Tells whether the one panel of a small window has the graphs, too.
#[derive(Clone, Copy, PartialEq, Eq)]
enum GraphsTab {
    Shown,
    None,
}

/// One panel for all in a window that has no room for two, or none for graphs below the canvas.
fn tabs(ui: &mut Ui, state: &AppState, graphs_tab: GraphsTab, commands: &mut Vec<Command>) {
    // A large scale on a small screen: half of it stays for the picture.
    let most = 0.5 * ui.ctx().content_rect().width();
    let range = most.min(220.0)..=most.min(420.0);
    Panel::left("narrow").default_size(most.min(300.0)).size_range(range).show(ui, |ui| {
        let id = Id::unique("narrow tab");
        let mut tab: Tab = ui.data(|d| d.get_temp(id)).unwrap_or_default();
        if let (count @ 1.., Some(tool)) = state.ui.section_request
            && is_new(ui, Id::unique("tools used in tabs"), count)
        {
            let in_results = SectionColumn::Results.sections().contains(&Section::of_tool(tool));
            tab = if in_results && tool != ToolSection::Solver { Tab::Read } else { Tab::Edit };
        }
        ui.horizontal(|ui| {
            ui.selectable_value(&mut tab, Tab::Edit, "Edit")
                .on_hover_text("The outline, and what edits the selected thing");
            ui.selectable_value(&mut tab, Tab::Read, "Results")
                .on_hover_text("Warnings, readouts, safe reach, tension at a place, compare");
            if graphs_tab == GraphsTab::Shown {
                ui.selectable_value(&mut tab, Tab::Graphs, "Graphs")
                    .on_hover_text("Tension and more, over time and along the cable");
            }
        });
        ui.data_mut(|d| d.insert_temp(id, tab));
        // On the canvas they would lie over the handles of things.
        legend::beside(ui, state);
        safe_reach::legend_beside(ui, state);
        panels::warnings::worst(ui, state, commands);
        ui.separator();
        match tab {
            Tab::Graphs if graphs_tab == GraphsTab::Shown => panels::plots::ui(ui, state, commands),
            Tab::Read => scroll(ui, SectionColumn::Results, state, commands),
            Tab::Edit | Tab::Graphs => scroll(ui, SectionColumn::Edit, state, commands),
        }
    });
}

/// The section to scroll to, since something else is marked or selected than in the frame before:
/// where a tension comes from, a search that was begun elsewhere, a result that was pinned, or the
/// form of the selected thing. Warnings stay in sight above it.
fn newly_wanted(ui: &Ui, column: SectionColumn, state: &AppState) -> Option<Section> {
    let id = column.id();
    let marked = is_new(ui, Id::unique((id, "marked")), state.analysis.tension_marker)
        && state.analysis.tension_marker.is_some();
    let selected =
        is_new(ui, Id::unique((id, "selected")), state.selection.selected) && state.selection.selected.is_some();
    let holds = |section: Section| column.sections().contains(&section);
    // An item that is changed within the panel stays under the pointer.
    let from_elsewhere = !ui.ctx().pointer_latest_pos().is_some_and(|at| ui.max_rect().contains(at));
    if marked && from_elsewhere && holds(Section::MarkedPlace) {
        return Some(Section::MarkedPlace);
    }
    let searches = is_new(ui, Id::unique((id, "searches")), state.analysis.safe_reach.began);
    if searches && state.analysis.safe_reach.began.is_some() && from_elsewhere && holds(Section::SafeReach) {
        return Some(Section::SafeReach);
    }
    let (count, tool) = state.ui.section_request;
    let used = is_new(ui, Id::unique((id, "tools used")), count) && count > 0;
    if let Some(section) = tool.filter(|_| used).map(Section::of_tool)
        && holds(section)
    {
        return Some(section);
    }
    let pins = state.analysis.references.len();
    let pinned = is_new(ui, Id::unique((id, "pinned")), pins) && pins > 0;
    if pinned && from_elsewhere && holds(Section::Compare) {
        return Some(Section::Compare);
    }
    // The form stands on the right where there is such a panel, else below the outline.
    match (selected, column, state.ui.results_beside) {
        (true, SectionColumn::Results, true) if panels::warnings::has_more(state) => Some(Section::Warnings),
        (true, SectionColumn::Results, true) => Some(Section::Selected),
        (true, SectionColumn::Edit, false) => Some(Section::Selected),
        _ => None,
    }
}

/// Returns whether a value is another than in the frame before.
fn is_new<T: Copy + PartialEq + Send + Sync + 'static>(ui: &Ui, id: Id, now: T) -> bool {
    let before = ui.data(|d| d.get_temp::<T>(id));
    ui.data_mut(|d| d.insert_temp(id, now));
    before != Some(now)
}

/// A column of sections that scrolls.
fn scroll(ui: &mut Ui, column: SectionColumn, state: &AppState, commands: &mut Vec<Command>) {
    let shown = newly_wanted(ui, column, state);
    // The bar stands beside figures, not over their last letters.
    let bar = &mut ui.spacing_mut().scroll;
    (bar.floating_allocated_width, bar.bar_width) = (SCROLL_BAR_WIDTH, SCROLL_BAR_WIDTH);
    // Contents that are too wide scroll: they must not push the canvas aside.
    let area = ScrollArea::both().id_salt(column.id()).auto_shrink(false);
    // Another scene is read from its first figure on.
    let is_opened = is_new(ui, Id::unique((column.id(), "opened")), state.ui.scenes_opened);
    let area = if is_opened { area.scroll_offset(egui::Vec2::ZERO) } else { area };
    area.show(ui, |ui| {
        let width = ui.available_width();
        for &section in column.sections() {
            let title = section.title();
            let hidden = match section {
                // On the right where there is such a panel, else below the outline.
                Section::Selected => {
                    state.selection.selected.is_none() || (column == SectionColumn::Results) != state.ui.results_beside
                }
                Section::MarkedPlace => state.analysis.tension_marker.is_none(),
                Section::UnmarkedPlace => state.analysis.tension_marker.is_some(),
                Section::Warnings => !panels::warnings::has_more(state),
                _ => false,
            };
            if hidden {
                if section == Section::Warnings && column == SectionColumn::Results {
                    compensate_scroll(ui, ui.cursor().top());
                }
                continue;
            }
            let panel = section.panel(state);
            let top = ui.cursor().top();
            // Widgets above that come and go must not change identities below: a drag in a section
            // would end.
            let named = UiBuilder::new().scope_id(ui.scope_id().with(title));
            let drawn = ui.scope_builder(named, |ui| {
                // A section that is asked for is unfolded.
                let open = (shown == Some(section)).then_some(true);
                CollapsingHeader::new(title).default_open(true).open(open).show_unindented(ui, |ui| {
                    // One section that is too wide does not widen the others.
                    ui.set_max_width(width);
                    panel(ui, state, commands);
                })
            });
            let header = drawn.inner.header_response;
            if section == Section::Warnings && column == SectionColumn::Results {
                compensate_scroll(ui, top);
            }
            if shown == Some(section) {
                header.scroll_to_me(Some(egui::Align::TOP));
            }
            highlight::register(&header, &format!("{title} section"));
        }
        focus::scroll_to_focused(ui, ui.min_rect());
    });
}

/// Warnings that come and go do not move what the pointer is at below them: the panel scrolls by
/// what they, and what stands above the panel, take more or less than in the frame before. `top`:
/// where they begin.
fn compensate_scroll(ui: &Ui, top: f32) {
    let id = Id::unique("height of the warnings");
    let height = ui.clip_rect().top() + ui.cursor().top() - top;
    let before = ui.data(|d| d.get_temp::<f32>(id)).unwrap_or(height);
    ui.data_mut(|d| d.insert_temp(id, height));
    let pointer = ui.ctx().pointer_latest_pos().filter(|p| ui.clip_rect().contains(*p));
    // In this frame all that follows has moved already, but not the hand.
    if height != before && pointer.is_some_and(|p| p.y > ui.cursor().top().min(ui.cursor().top() + before - height)) {
        ui.scroll_with_delta_animation(vec2(0.0, before - height), ScrollAnimation::none());
        ui.ctx().request_repaint();
    }
}

//! Tools are the questions that are asked beside the answer, as verbs of a menu and of the palette:
//! each begins what it says and leads to the section in which it is answered.

use egui::{Button, Ui};

use crate::command::{Command, ViewCommand};
use crate::panels::analysis::tension_budget;
use crate::state::{AppState, ToolSection};

/// A question, as a verb.
pub struct Tool {
    /// The verb.
    pub name: &'static str,
    /// The question in a sentence.
    pub help: &'static str,
    /// It begins it; None: nothing on screen can be asked.
    pub command: Option<Command>,
}

/// All of them, in the order of the menu.
#[must_use]
pub fn tools(state: &AppState) -> [Tool; 8] {
    let solved = state.live.snapshot.solution.is_some();
    let tool = |name, help, section, command: Option<ViewCommand>| {
        let command = command.map(|c| Command::View(ViewCommand::UseTool(section, Box::new(c))));
        Tool { name, help, command }
    };
    let of_answer = |command| Some(command).filter(|_| solved);
    let most = tension_budget::at_the_largest(state).map(|marker| ViewCommand::SetTensionMarker(Some(marker)));
    [
        tool(
            "Find safe reach",
            "How far an end or the robot can be taken, and back, below the service tension",
            ToolSection::SafeReach,
            Some(ViewCommand::SearchSafeReach),
        ),
        tool(
            "Mark the greatest tension",
            "Breaks the greatest tension down into pull, weight, wind and friction",
            ToolSection::MarkedPlace,
            most,
        ),
        tool(
            "Pin this result",
            "Keeps what is on screen, to compare with what follows",
            ToolSection::Compare,
            Some(ViewCommand::AddReference),
        ),
        tool(
            "Compare all models",
            "Answers the scene at rest with each model and pins the answers",
            ToolSection::Compare,
            Some(ViewCommand::CompareModels),
        ),
        tool(
            "Find the friction range",
            "The same question with less and with more friction, as a ribbon in the graphs",
            ToolSection::FrictionRange,
            of_answer(ViewCommand::SetFrictionRange { shown: true, factors: state.analysis.friction_range.factors }),
        ),
        tool(
            "Plot error against cost for all models",
            "Solves the scene at rest with every model and mesh, and plots error against computing time",
            ToolSection::Solver,
            of_answer(ViewCommand::ChartWorkPrecision),
        ),
        tool(
            "Compare with the likely bending stiffness",
            "How much of the answer changes where the cable resists bending",
            ToolSection::Readouts,
            of_answer(ViewCommand::AskBending),
        ),
        tool(
            "Unpin all",
            "Forgets the pinned results",
            ToolSection::Compare,
            Some(ViewCommand::RemoveReferences(None)).filter(|_| !state.analysis.references.is_empty()),
        ),
    ]
}

/// The entries of the menu.
pub fn menu(ui: &mut Ui, state: &AppState, commands: &mut Vec<Command>) {
    for Tool { name, help, command } in tools(state) {
        let entry = ui.add_enabled(command.is_some(), Button::new(name));
        if entry.on_hover_text(help).on_disabled_hover_text(help).clicked() {
            commands.extend(command);
            ui.close();
        }
    }
}

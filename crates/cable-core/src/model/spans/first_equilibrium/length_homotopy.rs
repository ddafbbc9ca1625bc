//! This module is a homotopy in length: a slack cable is shortened until it is taut along its
//! route, and paid out again step by step once it has an equilibrium.

use crate::math::Vec2;
use crate::model::spans::boundary::{LooseSection, Mode};
use crate::model::spans::continuation::StepStats;
use crate::model::spans::first_equilibrium::first_shapes::{ALONG_ROUTE, FirstLength, FirstShape, SlackCable};
use crate::model::spans::initial::{section_along_route, tightening};
use crate::model::spans::newton::Workspace;
use crate::model::spans::section::{BoundaryConditions, CableEquilibrium, Contact, Failure};
use crate::model::spans::section_layout::SectionLayout;
use crate::model::spans::slack::{self, LooseShapes};

impl CableEquilibrium {
    /// Lays the cable along its route with a very small tension, whether or not it could lie there
    /// loose.
    pub(in crate::model::spans) fn place_in_tension(
        &mut self,
        layout: &SectionLayout,
        goal: &BoundaryConditions,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        self.settle_along_route(layout, goal, FirstShape { slack: SlackCable::Nowhere, ..ALONG_ROUTE }, workspace)
    }

    /// Lays the cable along its route and finds its equilibrium: with its whole length, or shrunk
    /// until it is taut and then paid out again.
    pub(in crate::model::spans) fn settle_along_route(
        &mut self,
        layout: &SectionLayout,
        goal: &BoundaryConditions,
        shape: FirstShape,
        workspace: &mut Workspace,
    ) -> Result<StepStats, Failure> {
        let tuned = &layout.settings.continuation;
        let taut = shape.length.tension_weights(tuned);
        let mut begin = goal.clone();
        layout.set_context(&mut self.context, &begin);
        let routes = self.place_sections(layout, &begin, shape)?;
        if let Some(taut) = taut {
            begin.thermal = self.shrunk_thermal(layout, goal, taut);
            begin.load *= tuned.first_load_fraction;
            begin.forces.iter_mut().for_each(|f| *f *= tuned.first_load_fraction);
            layout.set_context(&mut self.context, &begin);
            for (section, part) in self.sections.iter_mut().zip(&layout.sections) {
                if part.supports.iter().all(Option::is_some) {
                    tightening::tighten(section, &self.context);
                }
            }
        }
        self.instant = begin.clone();
        let mut stats = self.step_from(layout, &begin, &routes, workspace)?;
        let frictionless = self.contacts_with_friction().all(|c| c.smooth);
        if self.end_smoothness() {
            stats = stats.plus(self.step(layout, &begin, workspace)?);
            let holds = self.contacts_with_friction().all(|c| c.mode == Mode::Stick);
            stats.found_without_friction = frictionless && holds && taut.is_none();
        }
        if taut.is_none() {
            return Ok(stats);
        }
        let heavy = BoundaryConditions { thermal: begin.thermal, ..goal.clone() };
        stats = stats.plus(self.advance_load(layout, &heavy, tuned.first_step, workspace)?);
        Ok(stats.plus(self.advance_load(layout, goal, tuned.first_step, workspace)?))
    }

    /// Lays each section along its route; returns the routes, an empty one for a loose section.
    fn place_sections(
        &mut self,
        layout: &SectionLayout,
        begin: &BoundaryConditions,
        shape: FirstShape,
    ) -> Result<Vec<Vec<Vec2>>, Failure> {
        let may_lie_loose = shape.length == FirstLength::Whole && shape.slack != SlackCable::Nowhere;
        self.sections.clear();
        let mut routes = Vec::new();
        for k in 0..layout.sections.len() {
            let loose = if may_lie_loose {
                slack::loose_section(layout, k, &self.context, begin, LooseShapes::NoTension)
            } else {
                None
            };
            if let Some(section) = loose.filter(|s| s.loose.as_ref().is_some_and(LooseSection::spreads)) {
                self.sections.push(section);
                routes.push(Vec::new());
                continue;
            }
            let on_route = section_along_route::section_along_route(layout, k, &self.context, begin);
            let no_way = Failure::ContactImpossible { s: layout.sections[k].material[0], at: begin.places[0] };
            let (section, route) = on_route.ok_or(no_way)?;
            self.sections.push(section);
            routes.push(route);
        }
        Ok(routes)
    }

    fn contacts_with_friction(&self) -> impl Iterator<Item = &Contact> {
        let contacts = self.sections.iter().flat_map(|s| &s.contacts);
        contacts.filter(|c| self.context.curves[c.curve].friction > 0.0)
    }

    /// Gives friction to the contacts that were met on the path to an equilibrium; returns whether
    /// there were any.
    fn end_smoothness(&mut self) -> bool {
        let mut met = false;
        for c in self.sections.iter_mut().flat_map(|s| &mut s.contacts).filter(|c| c.smooth) {
            c.smooth = false;
            met = true;
            if self.context.friction(c) > 0.0 {
                c.mode = Mode::Stick;
            }
        }
        met
    }

    /// The factor of lengths with which the cable lies along its route at a tension of so many
    /// weights.
    fn shrunk_thermal(&self, layout: &SectionLayout, goal: &BoundaryConditions, taut: f64) -> f64 {
        let p = &layout.problem;
        let drawn: f64 = goal.forces.iter().map(|f| f.norm()).sum();
        let tension = taut * goal.load.norm() * p.length + drawn;
        let mut least = goal.thermal;
        for s in &self.sections {
            let way = tightening::taut_length(s, &self.context);
            let taut = way / ((s.to - s.from) * (1.0 + tension / p.axial_stiffness));
            if taut < least && taut > 0.0 {
                least = taut;
            }
        }
        least
    }
}

//! The energy account goes on where models are replaced: at breaks, and where a piece runs off a
//! pulley.
//!
//! A model accounts for the energy of its own cable. Those that follow one begin anew, with the
//! energy that their meshes count for the state they start from. So the account of the cable is
//! that of the former models, the difference of the energies where they were replaced, and the
//! accounts of the present ones.

use super::SimulatedCable;
use super::former_energy::{FormerEnergy, ReplacementReason};
use super::piece::CablePiece;
use crate::math::larger;
use crate::model::Mechanics;
use crate::solution::{Energy, EnergyAccount};

impl SimulatedCable {
    /// Adds the account of a model that `next` ones replace in its present state; `answer` is its
    /// last.
    pub(super) fn replace_account(&mut self, k: usize, next: &[&dyn Mechanics], why: ReplacementReason) {
        let Some(old) = self.pieces.get(k) else { return };
        // A model that replaced another one may itself be replaced before its first step.
        let begun = old.answer.energy_account.or(self.former_energy.map(|_| EnergyAccount::default()));
        let after: Option<Energy> = next.iter().map(|m| m.stored_energy()).sum();
        let (Some(account), Some(before), Some(after)) = (begun, old.mechanics.stored_energy(), after) else {
            self.former_energy = None;
            return;
        };
        let gained: Energy = [account.gained, after, before * -1.0].into_iter().sum();
        let given = after.total_j() - before.total_j();
        let account = match why {
            ReplacementReason::Break => EnergyAccount { gained, breaks_j: account.breaks_j + given, ..account },
            ReplacementReason::Edit => EnergyAccount { gained, edits_j: account.edits_j + given, ..account },
        };
        self.former_energy = Some(match self.former_energy {
            Some(former) => {
                let exchanged_j = former.account.exchanged_j;
                FormerEnergy { account: EnergyAccount { exchanged_j, ..former.account.with(&account) }, ..former }
            }
            None => FormerEnergy { account, from_s: old.mechanics.time_s() - account.over_s },
        });
    }

    /// The energy account of all pieces since the cable began to move, where each has one; if the
    /// account of the former models is not known, since then.
    pub(super) fn energy_account(&self) -> Option<EnergyAccount> {
        let own = |p: &CablePiece| p.answer.energy_account;
        let Some(former) = self.former_energy else {
            let accounts: Option<Vec<EnergyAccount>> = self.pieces.iter().map(own).collect();
            return accounts?.into_iter().reduce(|a, b| a.with(&b));
        };
        let sum = self.pieces.iter().filter_map(own).fold(former.account, |sum, account| sum.with(&account));
        let exchanged_j = larger(former.account.exchanged_j, sum.half_sum_j());
        Some(EnergyAccount { over_s: self.time_s() - former.from_s, exchanged_j, ..sum })
    }

    /// Notes the energy that was exchanged so far, by which an imbalance is measured.
    pub(super) fn note_exchanged_energy(&mut self) {
        let now = self.energy_account();
        if let (Some(former), Some(now)) = (&mut self.former_energy, now) {
            former.account.exchanged_j = now.exchanged_j;
        }
    }
}

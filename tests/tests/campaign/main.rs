//! The campaign checks random scenes of every kind of rest against laws that are written here
//! alone.
//!
//! `CAMPAIGN_SEED=7 CAMPAIGN_CASES=200 cargo test --release -p cable-tests
//! --test campaign -- --include-ignored --nocapture`
//!
//! | variable | meaning |
//! |---|---|
//! | `CAMPAIGN_SEED` | first seed |
//! | `CAMPAIGN_CASES` | scenes a family |
//! | `CAMPAIGN_FAMILIES` | names, or parts of them, parted by commas; left out, all |
//! | `CAMPAIGN_OUT` | folder into which scenes go that are wrong, refused or slow |
//!
//! | room | what is in it |
//! |---|---|
//! | `chance.rs`, `case.rs`, `families/` | (family, seed) → scene and what is known of its answer |
//! | `closed.rs` | closed forms |
//! | `judge.rs` | the laws, by brute force |
//! | `stability.rs` | a rest is stable |
//! | `relations.rs` | scenes that must have the same answer |
//! | `driver.rs` | one case from scene to verdict |
//! | `choice.rs` | what `auto` costs beside other settings |
//! | `known.rs` | open faults, by family and count |

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a failing test is meant to panic

mod case;
mod chance;
mod choice;
mod closed;
mod driver;
mod families;
mod judge;
mod known;
mod relations;
mod stability;

use driver::{Plan, Tally, run};

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|n| n.parse().ok())
}

fn names() -> Vec<String> {
    let all = std::env::var("CAMPAIGN_FAMILIES").unwrap_or_default();
    all.split(',').filter(|n| !n.is_empty()).map(str::to_owned).collect()
}

/// A campaign fails by wrong answers, words that no user can read, and more than 2 % of scenes
/// refused that have a resting place; open faults are counted off.
fn judged(tallies: &[Tally], open: &[known::Open]) {
    let mut failures = Vec::new();
    for t in tallies {
        let known = open.iter().find(|k| k.family == t.family);
        let allowed = |count: fn(&known::Open) -> usize| known.map_or(0, count);
        let mut tell = |what: &str, found: usize, allowed: usize, lines: &[String]| {
            if found > allowed {
                failures.push(format!("{}: {found} {what}, {allowed} known\n    {}", t.family, lines.join("\n    ")));
            }
        };
        tell("wrong", t.wrong.len(), allowed(|k| k.wrong), &t.wrong);
        tell("refused", t.refused.len(), allowed(|k| k.refused).max(t.cases / 50), &t.refused);
        tell("outside of what they say", t.outside.len(), allowed(|k| k.outside), &t.outside);
        tell("in private words", t.private.len(), 0, &t.private);
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A few scenes of each family, always the same ones.
#[test]
fn every_family_rests_by_the_laws() {
    let plan = Plan { first: 0, cases: 2, names: names(), relations: 1, second_model: false, ..Plan::default() };
    judged(&run(&plan), known::IN_CI);
}

/// Scenes of earlier campaigns whose answers broke a law, by family and seed.
#[test]
fn scenes_that_were_wrong_are_right() {
    let were_wrong = [
        // A bar beside an end on a round was longer than its material.
        ("supports in things", 120_004),
        // Friction of cable that lies before a corner was reported where the cable leaves it.
        ("terraces and walls", 120_031),
        ("slack over things", 210_036),
        // An arc was drawn wider than it was, as its mark was no unit vector.
        ("ground by fem", 210_012),
        // A mesh was begun without the node at a crest, and a bar cut it by 19 mm.
        ("ground by fem", 510_298),
        // Cable in folds was given away to the bars beside them, and no rest was found from there.
        ("ground by fem", 740_122),
        ("ground by fem", 740_146),
        // Twice as long it is more than a kilometre, and was refused: contacts pushed from 6 mm
        // off.
        ("ground by fem", 740_116),
        // Friction beyond its cone on one pipe was let pass as what all bends together may hide.
        ("tank with beams", 470_176),
        // The slack of a bar beside a post was drawn on the post, under tension.
        ("tank with beams", 470_048),
        ("tank with beams", 470_092),
        // A strand without tension was solved a thousandfold more loosely than others.
        ("terraces and walls", 930_124),
        // Tension on a pipe was drawn as if friction multiplied what weight alone leaves of it.
        ("tank with beams", 930_024),
        // Rounding was taken for progress, until no iterations were left.
        ("smooth wheels", 930_298),
        // A mesh on which friction is a quarter beyond what its law allows was not refined.
        ("slack over things", 970_148),
        // A kilometre away no rest was found from that of a cable with 9.5e4 times as much
        // stiffness as weight.
        ("slack over things", 970_145),
        // Drawn to and fro for other histories without a bound of work: no answer in 60 s.
        ("slack over things", 980_030),
        // Gone in steps of a millionth: no answer in 60 s.
        ("pits and crests", 1_000_563),
        // Slack cable on a pipe drawn with 2.5 N between nodes with 1.5 N, by `fem` as a second
        // opinion.
        ("tank with beams", 1_200_248),
        // A copy with 1e-7 more cable rested elsewhere, by a quarter of the greatest tension, and
        // the range of other histories did not hold it.
        ("wind over ground", 1_200_027),
        // Of three wheels one is left: posts in place of all could not be laid past.
        ("smooth wheels", 1_990_235),
        ("rubbing wheels", 1_992_094),
        // Looped round a wheel in a sharp V.
        ("smooth wheels", 980_052),
        // Balances that run away at the least push were shown as rest.
        ("even pulleys", 1),
        ("even pulleys", 41),
        ("even posts", 8),
        // Of two balances one was shown without a word.
        ("even posts", 36),
        // A cable laid along a straight line stood on itself as a row of beads does.
        ("self-contact", 480_267),
    ];
    for (family, first) in were_wrong {
        let names = vec![family.to_owned()];
        let plan = Plan { first, cases: 1, names, relations: 2, second_model: true, ..Plan::default() };
        judged(&run(&plan), &[]);
    }
}

/// As many as are asked for.
#[test]
#[ignore = "minutes to hours: see the top of this file"]
fn campaign() {
    let plan = Plan {
        first: number("CAMPAIGN_SEED").unwrap_or(1000),
        cases: number("CAMPAIGN_CASES").unwrap_or(30) as usize,
        names: names(),
        relations: 2,
        second_model: true,
        out: std::env::var("CAMPAIGN_OUT").ok().map(Into::into),
        ..Plan::default()
    };
    judged(&run(&plan), &[]);
}

/// `auto` is within its tolerance, and costs no more than three times the cheapest setting that is.
#[test]
#[ignore = "minutes: every scene by three models on seven meshes"]
fn auto_is_near_and_cheap() {
    let first = number("CAMPAIGN_SEED").unwrap_or(2000);
    let found = choice::compare(first, number("CAMPAIGN_CASES").unwrap_or(15) as usize, &names());
    let count = found.ratios.len();
    let share = |most: f64| found.ratios.iter().filter(|r| **r <= most).count() as f64 / count as f64;
    println!(
        "{} scenes, {} within the tolerance, {} more say that they are not",
        found.scenes, found.within, found.flagged
    );
    println!(
        "cost over the cheapest that is near enough, of {count}: median {:.2}, at most 3 in {:.1} %, 10 in {:.1} %",
        found.ratios[count / 2],
        100.0 * share(3.0),
        100.0 * share(10.0)
    );
    for (ratio, scene) in found.dearest.iter().take(12) {
        println!("  {ratio:.1} {scene}");
    }
    assert!(100 * (found.within + found.flagged) >= 99 * found.scenes, "{} of {}", found.within, found.scenes);
}

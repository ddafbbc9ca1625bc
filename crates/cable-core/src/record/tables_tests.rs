//! These tests write the tables of a run and read them back.

use std::io::Write;

use super::node_choice::node_values;
use super::*;
use crate::model::Model;
use crate::solution::{
    CableSolution, Cost, Energy, EnergyAccount, ModelReason, Node, Solution, SupportReaction, Warning, WarningCause,
    WarningKind,
};
use proptest::prelude::*;

fn solution(time_s: f64, values: [f64; NodeColumns::COUNT], name: &str) -> Solution {
    let [arc_length_m, x_m, y_m, vx_m_per_s, vy_m_per_s, tension_n, strain, stress_pa, curvature_per_m, more @ ..] =
        values;
    let [dx_m, dy_m, ax_m_per_s2, ay_m_per_s2] = more;
    let node = Node {
        arc_length_m,
        x_m,
        y_m,
        vx_m_per_s,
        vy_m_per_s,
        tension_n,
        strain,
        stress_pa,
        curvature_per_m,
        displacement_m: [dx_m, dy_m],
        acceleration_m_per_s2: [ax_m_per_s2, ay_m_per_s2],
        ..Node::default()
    };
    let support = SupportReaction { name: name.to_owned(), reaction_x_n: x_m, reaction_y_n: y_m, ..Default::default() };
    let warning = Warning {
        kind: WarningKind::InitialPenetration,
        cable: name.to_owned(),
        arc_length_m,
        at_m: None,
        since_s: None,
        value: x_m,
        limit: y_m,
        cause: WarningCause::RouteBuried { obstacle: format!("a \"{name}\",\nsays who") },
    };
    Solution {
        time_s,
        model: Model::Fem,
        reason: ModelReason::Requested,
        next_cheaper: None,
        cables: vec![CableSolution {
            name: name.to_owned(),
            nodes: vec![node].into(),
            supports: vec![support],
            energy_account: Some(EnergyAccount { supports_j: x_m, exchanged_j: y_m, ..Default::default() }),
            ..Default::default()
        }],
        warnings: vec![warning],
        cost: Cost::default(),
        energy: Energy { kinetic_j: x_m, gravity_j: y_m, stretch_j: strain, bending_j: stress_pa },
        robot: None,
        verification: None,
    }
}

fn write(solutions: &[Solution]) -> [Vec<u8>; 3] {
    let (mut h, mut n, mut e) = (Vec::new(), Vec::new(), Vec::new());
    let mut w = RunWriter::new(&mut h, &mut n, &mut e);
    for s in solutions {
        w.push(s).unwrap();
    }
    w.flush().unwrap();
    drop(w);
    [h, n, e]
}

fn finite() -> impl Strategy<Value = f64> {
    any::<f64>().prop_filter("finite", |v| v.is_finite())
}

proptest! {
    #[test]
    fn values_come_back_bit_for_bit(values in prop::array::uniform13(finite()), time in finite(), name in "\\PC{1,12}") {
        let s = solution(time, values, &name);
        let [h, n, e] = write(std::slice::from_ref(&s));
        let nodes = read_nodes(n.as_slice()).unwrap();
        prop_assert_eq!(node_values(&nodes[0].node).map(f64::to_bits), values.map(f64::to_bits));
        prop_assert_eq!(&nodes[0].cable, &name);
        let history = read_history(h.as_slice()).unwrap();
        prop_assert_eq!(history.time_s[0].to_bits(), time.to_bits());
        prop_assert_eq!(history.supports[0].reaction_x_n[0].to_bits(), values[1].to_bits());
        prop_assert_eq!(&history.supports[0].name, &name);
        prop_assert_eq!(history.extras.len(), 17);
        prop_assert_eq!(history.extras[3].values[0].to_bits(), values[7].to_bits());
        let account = [6, 15, 16].map(|k| (history.extras[k].name, history.extras[k].values[0].to_bits()));
        let bits = f64::to_bits;
        let unaccounted = s.energy_account().unwrap().unaccounted_j();
        prop_assert_eq!(account[0], ("supports_work_j", bits(values[1])));
        prop_assert_eq!(account[1], ("exchanged_energy_j", bits(values[2])));
        prop_assert_eq!(account[2], ("unaccounted_energy_j", bits(unaccounted)));
        let events = read_events(e.as_slice()).unwrap();
        prop_assert_eq!(&events[0].cause, &s.warnings[0].cause);
        prop_assert_eq!(events[0].limit.to_bits(), values[2].to_bits());
    }

    #[test]
    fn arbitrary_bytes_are_refused_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read_nodes(bytes.as_slice());
        let _ = read_history(bytes.as_slice());
        let _ = read_events(bytes.as_slice());
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused_and_nothing_is_written() {
    let (mut h, mut n, mut e) = (Vec::new(), Vec::new(), Vec::new());
    let mut w = RunWriter::new(&mut h, &mut n, &mut e);
    let mut values = [0.0; NodeColumns::COUNT];
    values[5] = f64::NAN;
    let error = w.push(&solution(0.0, values, "a")).unwrap_err().to_string();
    assert!(error.contains("tension_n of node 0"), "{error}");
    w.flush().unwrap();
    drop(w);
    assert!(h.is_empty() && n.is_empty() && e.is_empty());
}

#[test]
fn a_lasting_warning_is_one_event() {
    let s: Vec<Solution> = (0..4).map(|k| solution(f64::from(k), [1.0; NodeColumns::COUNT], "a")).collect();
    let [_, _, e] = write(&s);
    assert_eq!(read_events(e.as_slice()).unwrap().len(), 1);
}

#[test]
fn two_breaks_of_a_cable_are_two_events_with_their_own_times() {
    let at = |time_s: f64, breaks: &[f64]| {
        let mut s = solution(time_s, [1.0; NodeColumns::COUNT], "a");
        let cause = |t: &f64| WarningCause::Broke { time_s: *t, over_s: 0.0, detached_from: None };
        let broke = |t: &f64| Warning { since_s: Some(*t), ..Warning::new(cause(t), "a", 1.0, [1.0, 1.0]) };
        s.warnings = breaks.iter().map(broke).collect();
        s
    };
    let [_, _, e] = write(&[at(0.0, &[]), at(0.1, &[0.07]), at(0.2, &[0.07, 0.13]), at(0.3, &[0.07, 0.13])]);
    let times: Vec<f64> = read_events(e.as_slice()).unwrap().iter().map(|e| e.time_s).collect();
    assert_eq!(times, [0.07, 0.13]);
}

#[test]
fn a_table_cut_short_is_read_up_to_its_last_whole_line() {
    let [_, n, _] =
        write(&[solution(0.0, [1.5; NodeColumns::COUNT], "a"), solution(1.0, [2.5; NodeColumns::COUNT], "a")]);
    let rows = read_nodes(&n[..n.len() - 12]).unwrap();
    assert_eq!(rows.iter().map(|r| r.time_s).collect::<Vec<_>>(), [0.0]);
    // A line that is wrong, not cut, is refused with its number.
    let text = String::from_utf8(n).unwrap().replace("2.5,2.5\n", "2.5\n");
    let error = read_nodes(text.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("line 3"), "{error}");
}

/// Places and bytes of writes.
type Writes = Vec<(usize, Vec<u8>)>;

/// Each write of a run: which table, and what.
#[derive(Clone, Default)]
struct Journal(std::rc::Rc<std::cell::RefCell<Writes>>);
struct Journalled(usize, Journal);
impl Write for Journalled {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        self.1.0.borrow_mut().push((self.0, data.to_vec()));
        Ok(data.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Whichever byte is the last that reaches the disk, the tables can be read, up to the last instant
/// that is complete in all of them.
#[test]
fn a_run_cut_at_any_byte_is_read_up_to_its_last_whole_instant() {
    let journal = Journal::default();
    let [history, nodes, events] = [0, 1, 2].map(|k| Journalled(k, journal.clone()));
    let mut w = RunWriter::new(history, nodes, events);
    let solutions: Vec<Solution> = (0..5)
        .map(|k| {
            let mut s = solution(0.1 * f64::from(k), [0.5 + f64::from(k); NodeColumns::COUNT], "a \"b\"");
            s.cables[0].nodes = vec![s.cables[0].nodes[0]; 3].into();
            s.warnings.retain(|_| k % 2 == 1);
            s
        })
        .collect();
    let mut scene = crate::scene::catalog::hanging_span();
    scene.cables[0].supports.truncate(1);
    scene.cables[0].supports[0].name = "a \"b\"".to_owned();
    w.begin(&scene, RobotColumns::LeftOut).unwrap();
    for s in &solutions {
        w.push(s).unwrap();
    }
    let writes = journal.0.borrow().clone();
    let total: usize = writes.iter().map(|(_, data)| data.len()).sum();
    let mut reached = Vec::new();
    for cut in 0..=total {
        let (mut tables, mut left) = ([Vec::new(), Vec::new(), Vec::new()], cut);
        for (table, data) in &writes {
            let part = &data[..data.len().min(left)];
            tables[*table].extend_from_slice(part);
            left -= part.len();
        }
        let [h, n, e] = &tables;
        let run = crate::record::read_run(h.as_slice(), n.as_slice(), e.as_slice()).unwrap();
        let instants = run.history.time_s.len();
        assert_eq!(run.nodes.len(), 3 * instants, "cut at {cut}");
        assert_eq!(run.events.len(), instants / 2, "cut at {cut}");
        assert!(run.history.time_s.iter().zip(&solutions).all(|(t, s)| *t == s.time_s));
        // Nothing is left out without a message.
        let whole_tables = write(&solutions[..instants]);
        let all_kept = instants > 0 && [h, n, e].into_iter().zip(&whole_tables).all(|(now, then)| now == then);
        assert!(all_kept == run.left_out.is_empty() || instants == 0, "cut at {cut}: {:?}", run.left_out);
        reached.push(instants);
    }
    assert!(reached.windows(2).all(|w| w[0] <= w[1]) && reached.last() == Some(&5));
}

#[test]
fn chosen_nodes_are_written_and_read_back() {
    let choice = |interval| NodeChoice { columns: NodeColumns::named(["tension_n", "x_m"]).unwrap(), interval };
    let times: Vec<f64> = (0..=33).map(|k| f64::from(k) * 0.03).collect();
    let written = |choice: NodeChoice| {
        let (mut h, mut n, mut e) = (Vec::new(), Vec::new(), Vec::new());
        let mut w = RunWriter::new(&mut h, &mut n, &mut e).with_nodes(choice);
        for (k, t) in times.iter().enumerate() {
            let s = solution(*t, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0], "a");
            if k + 1 == times.len() { w.push_last(&s) } else { w.push(&s) }.unwrap();
        }
        drop(w);
        assert_eq!(read_history(h.as_slice()).unwrap().time_s, times, "the history has every output");
        (String::from_utf8(n.clone()).unwrap(), read_nodes(n.as_slice()).unwrap())
    };
    let (text, rows) = written(choice(NodeInterval::Seconds(0.3)));
    assert!(text.starts_with("time_s,cable,x_m,tension_n\n0.0,a,2.0,6.0\n"), "{text}");
    let at: Vec<f64> = rows.iter().map(|r| r.time_s).collect();
    assert_eq!(at, [times[0], times[10], times[20], times[30], times[33]], "and the last");
    assert_eq!([rows[0].node.x_m, rows[0].node.tension_n], [2.0, 6.0]);
    assert!(rows[0].node.y_m.is_nan(), "what is not there is no number");
    assert_eq!(written(choice(NodeInterval::EveryOutput)).1.len(), times.len());
    assert_eq!(written(choice(NodeInterval::Never)).0, "time_s,cable,x_m,tension_n\n");
    let error = NodeColumns::named(["tension"]).unwrap_err().to_string();
    assert!(error.contains("`tension`") && error.contains("tension_n"), "{error}");
}

#[test]
fn an_answer_with_other_supports_is_refused() {
    let mut w = RunWriter::new(Vec::new(), Vec::new(), Vec::new());
    w.push(&solution(0.0, [1.0; NodeColumns::COUNT], "a")).unwrap();
    let error = w.push(&solution(1.0, [1.0; NodeColumns::COUNT], "b")).unwrap_err();
    assert!(matches!(error, WriteError::Columns { .. }), "{error}");
}

/// Accepts everything until it is flushed, as a full disk behind a buffer does.
struct FullDisk;
impl Write for FullDisk {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        Ok(data.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Err(std::io::ErrorKind::StorageFull.into())
    }
}

#[test]
fn a_full_disk_is_reported_at_the_flush() {
    let mut w = RunWriter::new(FullDisk, FullDisk, FullDisk);
    w.push(&solution(0.0, [1.0; NodeColumns::COUNT], "a")).unwrap();
    assert!(matches!(w.flush(), Err(WriteError::Io { .. })));
}

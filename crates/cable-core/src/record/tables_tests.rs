use super::*;
use crate::model::Model;
use crate::solution::{CableSolution, Cost, Energy, SupportReaction};
use proptest::prelude::*;

fn solution(time_s: f64, values: [f64; 9], name: &str) -> Solution {
    let [arc_length_m, x_m, y_m, vx_m_per_s, vy_m_per_s, tension_n, strain, stress_pa, curvature_per_m] = values;
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
        ..Node::default()
    };
    let support = SupportReaction { name: name.to_owned(), reaction_x_n: x_m, reaction_y_n: y_m, ..Default::default() };
    let warning = Warning {
        kind: WarningKind::BendRadius,
        cable: name.to_owned(),
        arc_length_m,
        at_m: None,
        since_s: None,
        value: x_m,
        limit: y_m,
        message: format!("bent, \"{name}\"\nsays who"),
    };
    Solution {
        time_s,
        model: Model::Fem,
        reason: String::new(),
        cables: vec![CableSolution {
            name: name.to_owned(),
            nodes: vec![node],
            supports: vec![support],
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
    fn values_come_back_bit_for_bit(values in prop::array::uniform9(finite()), time in finite(), name in "\\PC{1,12}") {
        let s = solution(time, values, &name);
        let [h, n, e] = write(std::slice::from_ref(&s));
        let nodes = read_nodes(n.as_slice()).unwrap();
        prop_assert_eq!(node_values(&nodes[0].node).map(f64::to_bits), values.map(f64::to_bits));
        prop_assert_eq!(&nodes[0].cable, &name);
        let history = read_history(h.as_slice()).unwrap();
        prop_assert_eq!(history.time_s[0].to_bits(), time.to_bits());
        prop_assert_eq!(history.supports[0].reaction_x_n[0].to_bits(), values[1].to_bits());
        prop_assert_eq!(&history.supports[0].name, &name);
        prop_assert_eq!(history.extras.len(), 4);
        prop_assert_eq!(history.extras[3].values[0].to_bits(), values[7].to_bits());
        let events = read_events(e.as_slice()).unwrap();
        prop_assert_eq!(&events[0].message, &s.warnings[0].message);
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
    let mut values = [0.0; 9];
    values[5] = f64::NAN;
    let error = w.push(&solution(0.0, values, "a")).unwrap_err().to_string();
    assert!(error.contains("tension_n of node 0"), "{error}");
    w.flush().unwrap();
    drop(w);
    assert!(h.is_empty() && n.is_empty() && e.is_empty());
}

#[test]
fn a_lasting_warning_is_one_event() {
    let s: Vec<Solution> = (0..4).map(|k| solution(f64::from(k), [1.0; 9], "a")).collect();
    let [_, _, e] = write(&s);
    assert_eq!(read_events(e.as_slice()).unwrap().len(), 1);
}

#[test]
fn two_breaks_of_a_cable_are_two_events_with_their_own_times() {
    let at = |time_s: f64, breaks: &[f64]| {
        let mut s = solution(time_s, [1.0; 9], "a");
        let broke = |t: &f64| Warning { kind: WarningKind::Broken, since_s: Some(*t), ..s.warnings[0].clone() };
        s.warnings = breaks.iter().map(broke).collect();
        s
    };
    let [_, _, e] = write(&[at(0.0, &[]), at(0.1, &[0.07]), at(0.2, &[0.07, 0.13]), at(0.3, &[0.07, 0.13])]);
    let times: Vec<f64> = read_events(e.as_slice()).unwrap().iter().map(|e| e.time_s).collect();
    assert_eq!(times, [0.07, 0.13]);
}

#[test]
fn a_table_cut_short_is_refused_with_its_line() {
    let [_, n, _] = write(&[solution(0.0, [1.5; 9], "a"), solution(1.0, [2.5; 9], "a")]);
    let error = read_nodes(&n[..n.len() - 12]).unwrap_err().to_string();
    assert!(error.contains("line 3"), "{error}");
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
    w.push(&solution(0.0, [1.0; 9], "a")).unwrap();
    assert!(matches!(w.flush(), Err(WriteError::Io { .. })));
}

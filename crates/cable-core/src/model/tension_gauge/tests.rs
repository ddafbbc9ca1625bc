//! These tests feed the tension gauge with known histories of tension.

use super::*;

const OVER_S: f64 = 4e-3;

/// A cable of one tension all along it, told after every step of `h` (s) up to an end (s).
fn gauge_of(over_s: f64, limit: Limit, h: f64, end_s: f64, tension: impl Fn(f64) -> f64) -> TensionGauge {
    let mut gauge = TensionGauge::over(over_s);
    let arcs = [0.0, 0.5, 1.0];
    gauge.begin(0.0, TensionBefore::Same, &arcs, |_| tension(0.0));
    gauge.watch([limit]);
    for k in 1..=(end_s / h).round() as u32 {
        let t = h * f64::from(k);
        gauge.note(t, &arcs, |_| tension(t));
        gauge.keep();
    }
    gauge
}

fn breaks_at(tension_n: f64) -> Limit {
    Limit { tension_n, ..Limit::default() }
}

/// The mean of what rises evenly lags by half of the time it is taken over, whatever the steps.
#[test]
fn a_slow_rise_breaks_half_the_time_later() {
    for h in [1.7e-5, 3e-4, 1e-3, 1.0 / 240.0, 0.02, 0.1] {
        let gauge = gauge_of(OVER_S, breaks_at(100.0), h, 0.3, |t| 500.0 * t);
        let reached = gauge.reached().unwrap();
        assert!((reached.time_s - (0.2 + 0.5 * OVER_S)).abs() < 1e-9, "{h}: {}", reached.time_s);
        assert_eq!(reached.tension_n, 100.0);
        // It was not pulled on for longer than to the next look.
        let peaks = gauge.peaks().unwrap();
        assert!((100.9..101.6).contains(&peaks.greatest.tension_n) && peaks.held.tension_n == 100.0, "{h}: {peaks:?}");
    }
    let at_once = gauge_of(0.0, breaks_at(100.0), 1.0 / 240.0, 0.3, |t| 500.0 * t);
    assert!((at_once.reached().unwrap().time_s - 0.2).abs() < 1e-9);
}

/// A triangle as long as the time of the mean: its mean is half of its height.
#[test]
fn a_jerk_between_two_looks_is_seen_and_its_mean_with_it() {
    for begins in [0.0101, 0.01037, 0.0109] {
        let jerk = |t: f64| 1000.0 * (1.0 - ((t - begins) / (0.5 * OVER_S) - 1.0).abs()).max(0.0);
        let gauge = gauge_of(OVER_S, breaks_at(501.0), 1e-5, 0.03, jerk);
        let peaks = gauge.peaks().unwrap();
        assert!((peaks.greatest.tension_n - 1000.0).abs() < 5.0, "{peaks:?}");
        assert!((peaks.greatest.time_s - begins - 0.5 * OVER_S).abs() < 1.1e-5);
        assert!((480.0..500.1).contains(&peaks.held.tension_n), "{peaks:?}");
        assert_eq!((gauge.reached(), peaks.over_s), (None, OVER_S));
        assert!(gauge_of(OVER_S, breaks_at(475.0), 1e-5, 0.03, jerk).reached().is_some());
        assert!(gauge_of(0.0, breaks_at(900.0), 1e-5, 0.03, jerk).reached().is_some());
    }
}

/// Nodes come, go and slide: means are those of the material.
#[test]
fn means_are_of_material_points() {
    let mut gauge = TensionGauge::over(OVER_S);
    let along = |s: f64| 100.0 + 50.0 * s;
    let first = [0.0, 1.0, 2.0, 4.0];
    gauge.begin(0.0, TensionBefore::Zero, &first, |k| along(first[k]));
    gauge.watch([Limit::default()]);
    for k in 1..200 {
        let s = 1.0 + 0.004 * f64::from(k);
        let arcs = if k % 3 == 0 { vec![0.0, s, 4.0] } else { vec![0.0, 0.3, s, s + 0.5, 4.0] };
        gauge.note(f64::from(k) * 1e-4, &arcs, |k| along(arcs[k]));
        gauge.keep();
    }
    let peaks = gauge.peaks().unwrap();
    for peak in [peaks.greatest, peaks.held] {
        assert!((peak.tension_n - 300.0).abs() < 1e-9 && peak.arc_length_m == 4.0, "{peaks:?}");
    }
    // Not at rest before: what was not seen does not count.
    let mut young = TensionGauge::over(OVER_S);
    young.begin(0.0, TensionBefore::Zero, &[0.0, 1.0], |_| 100.0);
    young.watch([Limit::default()]);
    young.note(0.5 * OVER_S, &[0.0, 1.0], |_| 100.0);
    young.keep();
    assert!((young.peaks().unwrap().held.tension_n - 50.0).abs() < 1e-9, "{young:?}");
}

#[test]
fn a_step_that_is_discarded_does_not_count() {
    let mut gauge = TensionGauge::over(OVER_S);
    gauge.begin(1.0, TensionBefore::Same, &[0.0, 1.0], |_| 10.0);
    gauge.watch([Limit::default()]);
    gauge.note(1.001, &[0.0, 1.0], |_| 1e6);
    gauge.note(1.0005, &[0.0, 1.0], |_| 11.0);
    gauge.keep();
    assert_eq!(gauge.peaks().unwrap().greatest.tension_n, 11.0);
    assert!(!gauge.asks(1.0005) && gauge.asks(1.001) && !TensionGauge::off().asks(7.0));
}

/// A model of a copy four times as large, in which time runs twice as fast.
#[test]
fn a_copy_is_gauged_in_the_lengths_and_times_of_the_cable() {
    let mut gauge = TensionGauge::over(OVER_S);
    gauge.of_copy([4.0, 2.0]);
    gauge.begin(0.0, TensionBefore::Same, &[0.0, 4.0], |_| 0.0);
    gauge.watch([breaks_at(100.0)]);
    for k in 1..=100 {
        let t = 0.02 * f64::from(k);
        gauge.note(t, &[0.0, 4.0], |k| if k == 1 { 100.0 * t } else { 0.0 });
        gauge.keep();
    }
    let reached = gauge.reached().unwrap();
    assert!((reached.time_s - 0.502).abs() < 1e-9 && reached.arc_length_m == 1.0, "{reached:?}");
}

/// Nothing breaks before it is watched, nor where it may not.
#[test]
fn a_limit_has_its_time_and_its_place() {
    let limit = Limit { tension_n: 10.0, from_s: 0.1, within_m: [0.2, 0.8] };
    let reached = gauge_of(OVER_S, limit, 1e-3, 0.2, |_| 20.0).reached().unwrap();
    assert!(reached.arc_length_m == 0.5 && (reached.tension_n - 20.0).abs() < 1e-9, "{reached:?}");
    assert!((reached.time_s - 0.1).abs() < 1.1e-3, "{reached:?}");
}

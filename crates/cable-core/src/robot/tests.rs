//! These tests compare the vehicle with its balance of forces by hand.

use super::*;
use crate::scene::{Obstacle, Shape, catalog};

const G: f64 = crate::scene::STANDARD_GRAVITY;

/// A slope (rise over run) with a vehicle in its middle.
fn on_slope(slope: f64, change: impl FnOnce(&mut Robot)) -> Vehicle {
    let mut scene = catalog::hanging_span();
    scene.obstacles = vec![Obstacle {
        name: "ground".to_owned(),
        shape: Shape::Terrain { points_m: vec![[-500.0, -500.0 * slope], [500.0, 500.0 * slope]] },
        friction: None,
    }];
    let mut robot = Robot { preset: "brokk-110".to_owned(), track_friction: Some(10.0), ..Robot::default() };
    change(&mut robot);
    scene.robot = Some(robot);
    Vehicle::of(&scene).unwrap()
}

/// One step under a force on the hitch, N.
fn step(v: &mut Vehicle, hitch: Vec2) {
    let pulls = Pulls { hitch, ..Pulls::default() };
    let drive = v.begin(STEP_S, pulls);
    let speed = v.foreseen(drive);
    match v.pose_at_speed(drive, speed) {
        Some(to) => {
            let balance = v.balance(drive, pulls);
            v.arrive(drive, to, speed, balance, balance.speed, pulls);
        }
        None => v.stop(drive, pulls, DriveState::Blocked),
    }
}

fn run(v: &mut Vehicle, seconds: f64, hitch: Vec2) {
    for _ in 0..(seconds / STEP_S) as usize {
        step(v, hitch);
    }
}

/// m, P, v₀, c of the vehicle.
fn figures(v: &Vehicle) -> [f64; 4] {
    [v.preset.mass_kg.value, v.preset.drive_pull_n.value, v.preset.speed_m_per_s.value, v.rolling]
}

#[test]
fn its_speed_on_a_slope_is_that_of_the_balance() {
    for (slope, back_n) in [(0.0, 0.0), (0.0, 1500.0), (0.1, 0.0), (0.2, 500.0), (-0.1, 0.0), (-0.3, 2000.0)] {
        let mut v = on_slope(slope, |_| {});
        let [m, p, top, c] = figures(&v);
        let theta = f64::atan(slope);
        // The cable pulls back along the ground.
        let hitch = Vec2::new(-theta.cos(), -theta.sin()) * back_n;
        v.command(Some(top));
        run(&mut v, 20.0, hitch);
        let resistance = m * G * theta.sin() + c * m * G * theta.cos() + back_n;
        let expected = (top * (1.0 - resistance / p)).min(top);
        assert!((v.speed - expected).abs() < 1e-9, "slope {slope}, {back_n} N: {} m/s, by hand {expected}", v.speed);
        let slowed = expected < top;
        assert_eq!(v.report.going, if slowed { DriveState::Slowed } else { DriveState::Driving }, "slope {slope}");
        assert!((v.report.thrust_n - resistance).abs() < 1e-6, "{} {resistance}", v.report.thrust_n);
        assert!((v.report.pitch_deg - theta.to_degrees()).abs() < 1e-9);
    }
}

#[test]
fn half_speed_asked_is_half_speed_driven() {
    let mut v = on_slope(0.1, |_| {});
    v.command(Some(-0.3));
    run(&mut v, 5.0, Vec2::zeros());
    assert!((v.speed + 0.3).abs() < 1e-12 && v.report.going == DriveState::Driving);
    // It gains its speed u within 2 √(u/J), with half of it on average.
    let way = 0.3 * 5.0 - 0.3 * (0.3 / governor::MAX_JERK).sqrt();
    assert!((v.pose.at_m[0] + way * v.pose.pitch.cos()).abs() < 0.3 * STEP_S, "{:?}", v.pose);
}

#[test]
fn it_stalls_just_beyond_its_drive_and_holds() {
    let v = on_slope(0.0, |_| {});
    let [m, p, top, c] = figures(&v);
    let most = p - c * m * G;
    for (share, moves) in [(0.99, true), (1.01, false), (3.0, false)] {
        let mut v = on_slope(0.0, |_| {});
        v.command(Some(top));
        run(&mut v, 20.0, Vec2::new(-most * share, 0.0));
        assert_eq!(v.speed > 1e-3, moves, "{share}: {}", v.speed);
        assert_eq!(v.report.going, if moves { DriveState::Slowed } else { DriveState::Stalled }, "{share}");
        assert!(v.pose.at_m[0] >= 0.0, "brakes hold it: {:?}", v.pose);
    }
}

#[test]
fn it_slips_where_the_pull_exceeds_what_its_tracks_hold() {
    let mu = 0.2;
    let slippery = |r: &mut Robot| r.track_friction = Some(mu);
    let v = on_slope(0.0, slippery);
    let [m, _, top, c] = figures(&v);
    // The vehicle can only move if μN ≥ H + cN.
    let most = (mu - c) * m * G;
    for (pull, seconds, expected) in [
        (0.98 * most, 60.0, DriveState::Slowed),
        (1.02 * most, 4.0, DriveState::Slipping),
        (0.99 * (mu + c) * m * G, 4.0, DriveState::Slipping),
        (1.05 * (mu + c) * m * G, 4.0, DriveState::Dragged),
    ] {
        let mut v = on_slope(0.0, slippery);
        v.command(Some(top));
        run(&mut v, seconds, Vec2::new(-pull, 0.0));
        assert_eq!(v.report.going, expected, "{pull} N of {most} N: {} m/s", v.speed);
        if expected == DriveState::Dragged {
            // It slides back with what friction and rolling leave.
            let slid = -(pull - (mu + c) * m * G) / m * 4.0;
            assert!((v.speed / slid - 1.0).abs() < 1e-9, "{} {slid}", v.speed);
        }
    }
    // An upward pull takes weight off the tracks: the same pull along the ground now slips.
    let mut v = on_slope(0.0, slippery);
    v.command(Some(top));
    run(&mut v, 4.0, Vec2::new(-0.8 * most, 0.5 * m * G));
    assert_eq!(v.report.going, DriveState::Slipping);
    assert!((v.report.normal_n - 0.5 * m * G).abs() < 1e-9);
}

#[test]
fn brakes_hold_on_a_slope_that_friction_holds() {
    for (slope, holds) in [(0.19, true), (0.3, false)] {
        let mut v = on_slope(slope, |r| r.track_friction = Some(0.2));
        run(&mut v, 2.0, Vec2::zeros());
        let expected = if holds { DriveState::Standing } else { DriveState::Dragged };
        assert_eq!((v.speed == 0.0, v.report.going), (holds, expected), "{slope}: {}", v.speed);
    }
}

#[test]
fn a_path_is_driven_leg_by_leg_and_again() {
    let drive = |to_x_m, speed_m_per_s| RobotTask::Drive { to_x_m, speed_m_per_s };
    let path = vec![drive(1.0, 0.5), RobotTask::Wait { wait_s: 3.0 }, drive(0.0, 0.5)];
    let mut v = on_slope(0.0, |r| r.path = path.clone());
    run(&mut v, 6.0, Vec2::zeros());
    assert!((v.pose.at_m[0] - 1.0).abs() < 2.0 * ARRIVAL_DISTANCE_M, "{:?}", v.report);
    run(&mut v, 10.0, Vec2::zeros());
    assert!(v.pose.at_m[0].abs() < 2.0 * ARRIVAL_DISTANCE_M && v.report.leg.is_none(), "{:?}", v.report);

    let mut again = on_slope(0.0, |r| (r.path, r.repeat) = (path.clone(), true));
    run(&mut again, 16.0, Vec2::zeros());
    assert!(again.report.leg.is_some(), "{:?}", again.report);
    // The second wait is as long as the first.
    let mut waits = on_slope(0.0, |r| r.path = vec![RobotTask::Wait { wait_s: 2.0 }, RobotTask::Wait { wait_s: 1.0 }]);
    run(&mut waits, 2.5, Vec2::zeros());
    assert_eq!(waits.report.leg, Some(1));
    run(&mut waits, 1.0, Vec2::zeros());
    assert_eq!(waits.report.leg, None);
    // All legs are done: the vehicle stands, and comes back.
    let mut idle = on_slope(0.0, |r| (r.path, r.repeat) = (vec![drive(0.0, 1.0)], true));
    run(&mut idle, 1.0, Vec2::zeros());
    assert_eq!(idle.speed, 0.0);
}

#[test]
fn it_stops_at_a_wall_and_at_the_end_of_the_ground() {
    let mut scene = catalog::hanging_span();
    let points_m = vec![[-5.0, 0.0], [5.0, 0.0], [5.0001, 3.0], [9.0, 3.0]];
    scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: None }];
    scene.robot = Some(Robot { preset: "brokk-110".to_owned(), ..Robot::default() });
    let mut v = Vehicle::of(&scene).unwrap();
    v.command(Some(0.8));
    run(&mut v, 20.0, Vec2::zeros());
    assert!(v.pose.at_m[0] < 5.0 && v.pose.at_m[0] > 4.0, "{:?}", v.report);
    assert_eq!(v.report.going, DriveState::Blocked);
    let mut v = on_slope(0.0, |r| r.at_m[0] = 499.0);
    v.command(Some(0.8));
    run(&mut v, 10.0, Vec2::zeros());
    assert!(v.report.going == DriveState::Blocked && v.pose.at_m[0] < 500.0);
}

#[test]
fn orders_that_are_not_numbers_are_not_taken() {
    let mut v = on_slope(0.0, |_| {});
    v.command(Some(f64::NAN));
    run(&mut v, 1.0, Vec2::zeros());
    assert_eq!(v.speed, 0.0);
    v.command(Some(1e9));
    run(&mut v, 5.0, Vec2::zeros());
    assert!(v.speed <= v.preset.speed_m_per_s.value);
}

#[test]
fn it_tips_over_an_edge_and_does_not_jump() {
    let mut scene = catalog::hanging_span();
    let points_m = vec![[-5.0, 0.0], [1.0, 0.0], [1.1, 0.15], [1.2, 0.0], [9.0, 0.0]];
    scene.obstacles = vec![Obstacle { name: "ground".to_owned(), shape: Shape::Terrain { points_m }, friction: None }];
    scene.robot = Some(Robot { preset: "brokk-110".to_owned(), ..Robot::default() });
    let mut v = Vehicle::of(&scene).unwrap();
    v.command(Some(0.5));
    let (mut before, mut most, mut rate) = (v.pose.pitch, 0.0_f64, 0.0);
    for _ in 0..(12.0 / STEP_S) as usize {
        step(&mut v, Vec2::zeros());
        assert!((v.pose.pitch - before).abs() <= MAX_TIP_RAD_PER_S * STEP_S * (1.0 + 1e-9));
        let now = (v.pose.pitch - before) / STEP_S;
        assert!((now - rate).abs() <= MAX_TIP_RAD_PER_S2 * STEP_S * (1.0 + 1e-9), "{rate} {now} rad/s");
        (before, rate) = (v.pose.pitch, now);
        most = most.max(before);
    }
    assert!(most > 0.1, "{most}");
    assert!(v.pose.pitch.abs() < 1e-12 && v.pose.at_m[0] > 2.5, "{:?}", v.report);
}

/// A swing of the pull about what the drive can just hold: above that it stands, held by its
/// brakes; below it goes on, and nothing is gained by the swing.
#[test]
fn a_swinging_pull_draws_it_on_only_while_it_is_less_than_the_drive() {
    let [m, p, top, c] = figures(&on_slope(0.0, |_| {}));
    let most = p - c * m * G;
    for (mean, goes) in [(1.2, false), (1.05, true)] {
        let mut v = on_slope(0.0, |_| {});
        v.command(Some(top));
        run(&mut v, 3.0, Vec2::new(-mean * most, 0.0));
        assert!(v.speed == 0.0 && v.report.going == DriveState::Stalled, "{:?}", v.report);
        let x = v.pose.at_m[0];
        for k in 0..1200_u32 {
            let swing = if k % 24 < 12 { 0.15 } else { -0.15 };
            step(&mut v, Vec2::new(-(mean + swing) * most, 0.0));
        }
        assert_eq!(v.pose.at_m[0] > x, goes, "{:?}", v.report);
        assert!((v.report.work.total_j() - v.kinetic_j()).abs() <= 1e-9 * v.report.work.drive_j, "{:?}", v.report);
        // Once the pull is removed for good, it drives on.
        run(&mut v, 2.0, Vec2::new(-0.5 * most, 0.0));
        assert!(v.pose.at_m[0] > x + 0.2, "{:?}", v.report);
    }
}

/// Thrown against a spring, without drive and rolling resistance, it comes back as fast, and is as
/// far then as its energy says.
#[test]
fn a_spring_throws_it_back_with_what_it_brought() {
    let mut v = on_slope(0.0, |r| (r.track_friction, r.rolling_resistance) = (Some(0.0), Some(0.0)));
    let (stiffness, begun) = (2e5, 0.6);
    v.speed = begun;
    let m = v.mass();
    let (mut farthest, mut left) = (0.0_f64, 0);
    while left < 1000 && (v.speed > 0.0 || v.pose.at_m[0] > 0.0) {
        // The step and the spring together, as robot and cable.
        let drive = v.begin(STEP_S, Pulls { hitch: Vec2::new(-stiffness * v.pose.at_m[0], 0.0), ..Pulls::default() });
        let mut speed = v.foreseen(drive);
        for _ in 0..50 {
            let to = v.pose_at_speed(drive, speed).unwrap();
            let pulls = Pulls { hitch: Vec2::new(-stiffness * to.at_m[0], 0.0), ..Pulls::default() };
            let balance = v.balance(drive, pulls);
            if (balance.speed - speed).abs() < 1e-13 {
                v.arrive(drive, to, speed, balance, balance.speed, pulls);
                break;
            }
            speed = balance.speed;
        }
        farthest = farthest.max(v.pose.at_m[0]);
        left += 1;
    }
    assert!((farthest / (begun * (m / stiffness).sqrt()) - 1.0).abs() < 2e-3, "{farthest}");
    let energy = v.kinetic_j() + 0.5 * stiffness * v.pose.at_m[0].powi(2);
    assert!((energy / (0.5 * m * begun * begun) - 1.0).abs() < 1e-9, "{energy} {:?}", v.report);
}

/// Dragged back by its cable it is braked at once by all that its tracks hold, and no motion is
/// lost in one step.
#[test]
fn dragged_back_it_slides_until_its_tracks_have_stopped_it() {
    let mut v = on_slope(0.0, |r| r.track_friction = Some(0.45));
    let [m, _, top, c] = figures(&v);
    v.command(Some(top));
    run(&mut v, 1.0, Vec2::new(-1.2 * (0.45 + c) * m * G, 0.0));
    assert!(v.speed < -0.5 && v.report.going == DriveState::Dragged, "{:?}", v.report);
    let (mut before, brakes) = (v.speed, (0.45 + c) * G);
    while v.speed < 0.0 {
        step(&mut v, Vec2::zeros());
        assert!((v.speed - before) / STEP_S <= brakes * (1.0 + 1e-9), "{before} {:?}", v.report);
        before = v.speed;
    }
    assert!((v.report.work.total_j() - v.kinetic_j()).abs() < 1e-9 * v.report.work.slip_j.abs(), "{:?}", v.report);
}

//! This module holds every tolerance of the verifier. They are fixed: an answer that fails is wrong
//! or its model inaccurate, and the tolerance is not widened.

/// Unbalanced force of the whole and of any piece, as a fraction of the greatest force in the
/// scene. Smaller: the models' own stopping rules (1e-6 of the whole load for `fem`, over some tens
/// of nodes) are refused; larger: cables that slide away pass (0.3 % were missing).
pub const BALANCE_FRACTION: f64 = 1e-5;

/// Change of momentum in a step that no impulse explains, as a fraction of the greatest impulse.
/// Smaller: what `fem` leaves unbalanced in a step (1e-6 of the whole load at each node: up to
/// 1.2e-5 was seen in steps of 600 violent scenes) is refused; larger: an error at one node of a
/// thousand is missed.
pub(crate) const MOMENTUM: f64 = 1e-4;

/// Unbalanced moment of a piece, of the greatest moment. A discrete rod balances moments about its
/// nodes exactly, the mean of forces beside a node is of the second order: 5 % for ten nodes on a
/// bend.
pub(crate) const MOMENT: f64 = 5e-2;

/// Compression of a flexible cable, of the greatest force: as the balance.
pub const COMPRESSION: f64 = 1e-5;

/// Missing or excess length, as a fraction of the material between two nodes. Smaller: rounding of
/// stiff, nearly taut cables, where a strain of 1e-9 is 1 N at EA 1e9; larger: folds that stand for
/// a stretch.
pub const LENGTH: f64 = 1e-6;

/// Relative deviation of the path between two nodes per square of the turn (rad) of the force:
/// straight bars and linear forces are of second order with 1/24, arcs with 1/8.
pub(crate) const TURN: f64 = 0.25;

/// Part of the turn that the weight of a bar and its neighbours makes, by which a bar beside a
/// contact may be off: weight that lies on a round is carried half by the bar beside it.
pub(crate) const LUMPED_WEIGHT_TURN: f64 = 0.5;

/// Turn of the force between two nodes (rad) above which the direction of their path is not
/// checked: the fold of a slack cable.
pub(crate) const FOLD_TURN: f64 = 0.5;

/// Allowed depth inside an obstacle, as a fraction of the diameter, but at most `DEPTH_M`.
pub(crate) const DEPTH_DIAMETERS: f64 = 0.02;
/// Upper limit of that depth, m: a picture to scale does not show it, and it is less than the
/// cable's deviation from a circle.
pub const DEPTH_M: f64 = 1e-3;
/// Allowed depth as a fraction of the cable's length, if that is more: arcs of cables of kilometres
/// are drawn to their own scale. A straight line between nodes may cut deeper by the same amount
/// where the cable is round, as for a thread on a large drum.
pub(crate) const DEPTH_LENGTHS: f64 = 1e-5;

/// Gap up to which an obstacle may push, as a fraction of the diameter: barriers push from 1e-4 m
/// on, and jackets yield by more.
pub(crate) const REACH_DIAMETERS: f64 = 0.05;
/// Lower limit of that gap, m: the reach of a barrier in motion.
pub(crate) const REACH_M: f64 = 1.2e-3;

/// Friction beyond the cone, as a fraction of the normal force: contacts of `fem` converge to 1e-4
/// of their forces.
pub(crate) const CONE_EXCESS: f64 = 1e-3;

/// Force of one piece beyond its cone, of the greatest force there, in the cable or of its contact;
/// all pieces together are held to [`CONE_EXCESS`]. Smaller: what bars that sag away from a corner
/// leave beside it is refused (a slow draw under a beam); larger: slack cable may be drawn with a
/// tension that no friction leads to, as what is allowed of all pieces together is much there.
pub(crate) const PIECE_EXCESS: f64 = 0.05;

/// Error of the arc lengths at the ends (0 and the length), as a fraction of the cable's length.
pub(crate) const MATERIAL_TOLERANCE: f64 = 1e-9;

/// Angle between two normals from which the ground turns there, rad: edges that differ by round-off
/// are one.
pub(crate) const NORMAL_TOLERANCE: f64 = 1e-6;

/// Strain whose force is the least scale of residuals of a cable without load, which has no other
/// scale.
pub(crate) const MIN_STRAIN: f64 = 1e-7;

/// Part of the greatest force that contacts and supports as they are reported, and tensions at
/// nodes where something touches, may leave of the whole. `fem` lags the normal forces that
/// friction uses by a round, and its contacts at corners are read off bars beside them: up to
/// 1.8e-3 was seen. That every piece is balanced by what touches it is asked to
/// [`BALANCE_FRACTION`]. Smaller: slow draws under beams by `fem` are refused; larger: a report
/// that leaves a contact out passes.
pub(crate) const REPORTED_BALANCE: f64 = 2e-3;

/// Shift of the ends of a touching bar along it, as a fraction of the diameter: a sagging cable
/// leaves a round a little before or after the straight bar that represents it.
pub(crate) const CONTACT_SHIFT_DIAMETERS: f64 = 1e-2;

/// Distance from its support within which a cable counts as held, as a fraction of the cable's
/// length: not visible.
pub(crate) const SUPPORT_TOLERANCE: f64 = 1e-6;

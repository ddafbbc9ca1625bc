//! Every tolerance of the checker stands here. They are pinned: an answer that fails is wrong or
//! its model coarse, never the tolerance.

/// Unbalanced force of the whole and of any piece, of the greatest force in the scene. Smaller: the
/// models' own stopping rules (1e-6 of the whole load for `fem`, over some tens of nodes) are
/// refused; larger: cables that slide away pass (0.3 % were missing).
pub const BALANCE_FRACTION: f64 = 1e-5;

/// Momentum that came from nowhere in a step, of the greatest impulse. Smaller: what `fem` leaves
/// unbalanced in a step (1e-6 of the whole load at each node: up to 1.2e-5 was seen in steps of 600
/// violent scenes) is refused; larger: what one node of a thousand does is not seen.
pub(crate) const MOMENTUM: f64 = 1e-4;

/// Unbalanced moment of a piece, of the greatest moment. A discrete rod balances moments about its
/// nodes exactly, the mean of forces beside a node is of the second order: 5 % for ten nodes on a
/// bend.
pub(crate) const MOMENT: f64 = 5e-2;

/// Compression of a flexible cable, of the greatest force: as the balance.
pub const COMPRESSION: f64 = 1e-5;

/// Length that is missing or too much, of the material between two nodes. Smaller: rounding of
/// stiff, nearly taut cables, where a strain of 1e-9 is 1 N at EA 1e9; larger: folds that stand for
/// a stretch.
pub const LENGTH: f64 = 1e-6;

/// Part of the square of the turn of the force between two nodes, by which their way may differ
/// from the exact one: straight bars and linear forces are of the second order with 1/24, arcs with
/// 1/8.
pub(crate) const TURN: f64 = 0.25;

/// Part of the turn that the weight of a bar and its neighbours makes, by which a bar beside a
/// contact may be off: weight that lies on a round is carried half by the bar beside it.
pub(crate) const LUMPED_WEIGHT_TURN: f64 = 0.5;

/// Turn of the force between two nodes above which nothing is asked of the direction of their way:
/// the fold of a slack cable.
pub(crate) const FOLD_TURN: f64 = 0.5;

/// Depth inside an obstacle, of the diameter …
pub(crate) const DEPTH_DIAMETERS: f64 = 0.02;
/// … and at most this, m (a picture to scale does not show it, and it is less than the cable's own
/// roundness).
pub const DEPTH_M: f64 = 1e-3;
/// … or this part of the cable's length, whichever is more: arcs of cables of kilometres are drawn
/// to their own scale. By as much at most a straight line between nodes may cut more, where the
/// cable is round: a thread on a large drum.
pub(crate) const DEPTH_LENGTHS: f64 = 1e-5;

/// Gap up to which an obstacle may push, of the diameter: barriers push from 1e-4 m off, jackets
/// give way by more.
pub(crate) const REACH_DIAMETERS: f64 = 0.05;
/// … and at least this, m: the reach of a barrier in motion.
pub(crate) const REACH_M: f64 = 1.2e-3;

/// Friction beyond the cone, of the normal force: contacts of `fem` stop at 1e-4 of their forces.
pub(crate) const CONE_EXCESS: f64 = 1e-3;

/// Force of one piece beyond its cone, of the greatest force there, in the cable or of its contact;
/// all pieces together are held to [`CONE_EXCESS`]. Smaller: what bars that sag away from a corner
/// leave beside it is refused (a slow draw under a beam); larger: slack cable may be drawn with a
/// tension that no friction leads to, as what is allowed of all pieces together is much there.
pub(crate) const PIECE_EXCESS: f64 = 0.05;

/// Part of the cable's length by which arc lengths at the ends may miss 0 and the length.
pub(crate) const MATERIAL_TOLERANCE: f64 = 1e-9;

/// Turn between two normals from which on the ground turns there, rad: edges that rounding alone
/// tells apart are one.
pub(crate) const NORMAL_TOLERANCE: f64 = 1e-6;

/// Strain whose force no residual of a cable without load is smaller than: a cable without weight
/// has no other scale.
pub(crate) const MIN_STRAIN: f64 = 1e-7;

/// Part of the greatest force that contacts and supports as they are reported, and tensions at
/// nodes where something touches, may leave of the whole. `fem` lags the normal forces that
/// friction uses by a round, and its contacts at corners are read off bars beside them: up to
/// 1.8e-3 was seen. That every piece is balanced by what touches it is asked to
/// [`BALANCE_FRACTION`]. Smaller: slow draws under beams by `fem` are refused; larger: a report
/// that leaves a contact out passes.
pub(crate) const REPORTED_BALANCE: f64 = 2e-3;

/// Distance along a bar that touches by which its ends may be elsewhere, of the diameter: a sagging
/// cable leaves a round a little before or after the straight bar that stands for it.
pub(crate) const CONTACT_SHIFT_DIAMETERS: f64 = 1e-2;

/// Distance from its support at which a cable is held by it, of the cable's length: what nobody
/// sees.
pub(crate) const SUPPORT_TOLERANCE: f64 = 1e-6;

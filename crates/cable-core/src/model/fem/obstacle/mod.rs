//! These modules move the robot's outline and check the cable against obstacles after a step.

pub(in crate::model::fem) mod intersection_check;
pub(in crate::model::fem) mod outline_depenetration;

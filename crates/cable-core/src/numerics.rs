//! Loops that several solvers share: bisection, the backtracking of a line search, and steps that
//! are halved where one fails.

/// Halves the interval between two numbers so many times; `first` is true of the numbers on the
/// side of the first of them. Returns what is left: between its ends `first` changes.
pub(crate) fn bisect([mut a, mut b]: [f64; 2], halvings: usize, mut first: impl FnMut(f64) -> bool) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (a + b);
        if first(middle) {
            a = middle;
        } else {
            b = middle;
        }
    }
    [a, b]
}

/// The first step of a line search that is accepted, of the length `longest`, half of that, and so
/// on, so many in all; None where none is.
pub(crate) fn backtrack<T>(longest: f64, tries: usize, mut accepted: impl FnMut(f64) -> Option<T>) -> Option<T> {
    let mut length = longest;
    for _ in 0..tries {
        let found = accepted(length);
        if found.is_some() {
            return found;
        }
        length *= 0.5;
    }
    None
}

/// Fraction of the decrease that the slope predicts which a step of a line search must give (L.
/// Armijo, *Pacific Journal of Mathematics* 16(1), 1966). Smaller: steps that hardly descend are
/// taken; larger, toward 1/2: full steps of Newton's method are refused.
pub(crate) const ARMIJO_FRACTION: f64 = 1e-4;

/// Most halvings of a step of a model: one of which a thousandth part fails, fails. Fewer: a step
/// fails where a corner or a pulley has to be met first; more: a failure costs more.
pub(crate) const MAX_HALVINGS: u32 = 10;

/// Even steps from a place to an end (times in s, or parts of a way). Where one fails all that
/// follow are half as long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalvedSteps {
    end: f64,
    step: f64,
    halvings: u32,
    max_halvings: u32,
    /// A rest of the way of less than this part of a step is taken with the step before it.
    joined: f64,
}

impl HalvedSteps {
    /// Steps to `end` of the length `step`, halved `max_halvings` times at most; what is left after
    /// one is taken with it if it is less than a part `joined` of a step.
    pub(crate) fn new(end: f64, step: f64, max_halvings: u32, joined: f64) -> Self {
        Self { end, step, halvings: 0, max_halvings, joined }
    }

    /// The end of the step that begins at `now`; None at the end of all.
    pub(crate) fn next(&self, now: f64) -> Option<f64> {
        let is_last = now + (1.0 + self.joined) * self.step >= self.end;
        (now < self.end).then_some(if is_last { self.end } else { now + self.step })
    }

    /// Halves the steps after one that failed; false if they were halved as often as they may be.
    pub(crate) fn halve(&mut self) -> bool {
        self.halvings += 1;
        self.step *= 0.5;
        self.halvings <= self.max_halvings
    }

    /// The length of a step.
    pub(crate) fn step(&self) -> f64 {
        self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bisection_finds_a_root_from_either_side() {
        let [low, high] = bisect([0.0, 2.0], 52, |x| x * x < 2.0);
        assert!(low * low < 2.0 && high * high >= 2.0 && high - low < 1e-15);
        let [high, low] = bisect([2.0, 0.0], 52, |x| x * x > 2.0);
        assert!(low * low <= 2.0 && high * high > 2.0 && high - low < 1e-15);
    }

    #[test]
    fn a_line_search_takes_the_longest_step_that_is_accepted() {
        assert_eq!(backtrack(1.0, 5, |part| (part < 0.2).then_some(part)), Some(0.125));
        assert_eq!(backtrack(1.0, 3, |part| (part < 0.2).then_some(part)), None);
    }

    #[test]
    fn steps_are_halved_and_end_where_they_should() {
        let mut steps = HalvedSteps::new(1.0, 0.25, 2, 0.5);
        let (mut now, mut ends) = (0.0, Vec::new());
        while let Some(next) = steps.next(now) {
            if next == 0.5 && steps.step() == 0.25 {
                assert!(steps.halve());
                continue;
            }
            ends.push(next);
            now = next;
        }
        assert_eq!(ends, [0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0]);
        assert!(steps.halve() && !steps.halve());
    }
}

//! This module names the day, the machine and the clock of a measurement.

use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Processor time is known to a tick of the system, 4 ms at most: it counts where it is more than
/// this, s.
const LEAST_PROCESSOR_S: f64 = 0.1;

/// The time that something took, s.
#[derive(Clone, Copy, Debug)]
pub struct Spent {
    elapsed_s: f64,
    processor_s: Option<f64>,
}

impl Spent {
    /// The least elapsed time of several runs, s, or their mean processor time where that is known
    /// and less: a run of some milliseconds never has a busy machine for itself.
    #[must_use]
    pub fn least_s(runs: &[Self]) -> f64 {
        let elapsed = runs.iter().map(|run| run.elapsed_s).fold(f64::INFINITY, f64::min);
        let processor: Option<f64> = runs.iter().map(|run| run.processor_s).sum();
        processor.filter(|s| *s > LEAST_PROCESSOR_S).map_or(elapsed, |s| elapsed.min(s / runs.len() as f64))
    }

    /// As [`Self::least_s`], of this one.
    #[must_use]
    pub fn seconds(self) -> f64 {
        Self::least_s(&[self])
    }

    /// Returns whether so many runs are to be followed by another: until there are `least` of them,
    /// and until their processor time is known.
    #[must_use]
    pub fn wants_more(runs: &[Self], least: usize) -> bool {
        let elapsed: f64 = runs.iter().map(|run| run.elapsed_s).sum();
        runs.len() < least || (elapsed > SHORT_S * runs.len() as f64 && elapsed < ENOUGH_S)
    }
}

/// A run shorter than this, s, has a core for itself once in a while.
const SHORT_S: f64 = 1e-3;

/// Elapsed time of several runs after which no more are made, s: then the processor has spent more
/// than [`LEAST_PROCESSOR_S`] on them on a machine that ten others share.
const ENOUGH_S: f64 = 1.0;

/// A clock of elapsed time and of the processor time of this thread, on which other programs do not
/// count.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    began: Instant,
    processor_s: Option<f64>,
}

impl Clock {
    /// Begins now.
    #[must_use]
    pub fn start() -> Self {
        Self { processor_s: processor_s(), began: Instant::now() }
    }

    /// Time since then.
    #[must_use]
    pub fn spent(&self) -> Spent {
        let elapsed_s = self.began.elapsed().as_secs_f64();
        Spent { elapsed_s, processor_s: processor_s().zip(self.processor_s).map(|(now, then)| now - then) }
    }
}

/// Processor time of this thread so far, s; None where the system does not say.
fn processor_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

/// Begins the sentence that [`measured_now`] makes.
pub const MEASURED: &str = "Measured on ";

/// A line for a page that shows times: day, cores, and how busy the machine was (the mean of five
/// minutes, /proc/loadavg), as a load above the cores slows what is measured.
#[must_use]
pub fn measured_now() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let [year, month, day] = civil(seconds / 86_400);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let busy = std::fs::read_to_string("/proc/loadavg").ok();
    let load = busy.and_then(|text| text.split_whitespace().nth(1).map(str::to_owned));
    let load = load.map_or_else(|| "unknown".to_owned(), |load| format!("of {load}"));
    format!("{MEASURED}{year}-{month:02}-{day:02} on a machine of {cores} cores whose load was {load} at the end.")
}

/// Year, month and day of so many days after the first of January 1970 (E. G. Richards, "Calendars"
/// in *Explanatory Supplement to the Astronomical Almanac*, 2013).
fn civil(days: u64) -> [u64; 3] {
    let number = days + 2_440_588;
    let f = number + 1401 + (4 * number + 274_277) / 146_097 * 3 / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * (e % 1461 / 4) + 2;
    let month = (h / 153 + 2) % 12 + 1;
    [e / 1461 - 4716 + (14 - month) / 12, month, h % 153 / 5 + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(civil(0), [1970, 1, 1]);
        assert_eq!(civil(11_016), [2000, 2, 29]);
        assert_eq!(civil(20_784), [2026, 11, 27]);
    }
}

//! The day, the machine and the clock of a measurement.

use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Processor time is known to a tick of the system, 4 ms at most: it counts where it is more than
/// this, s.
const LEAST_PROCESSOR_S: f64 = 0.1;

/// A clock that other programs on the machine do not make run faster, where what is measured takes
/// more than 0.1 s: the lesser of elapsed time and of the processor time of this thread.
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

    /// Time since then, s.
    #[must_use]
    pub fn spent_s(&self) -> f64 {
        let elapsed = self.began.elapsed().as_secs_f64();
        let processor = processor_s().zip(self.processor_s).map(|(now, then)| now - then);
        processor.filter(|s| *s > LEAST_PROCESSOR_S).map_or(elapsed, |s| s.min(elapsed))
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

//! Parsing of limits on the error and time of a picture.

use std::time::Duration;

/// Parses an error such as `55dB`, or `0.0018` as the root mean square over linear colours from 0 to 1.
pub fn parse_error(word: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|n| n.is_finite());
    let rmse = match word.to_ascii_lowercase().strip_suffix("db") {
        Some(decibels) => number(decibels).map(|decibels| 10.0_f64.powf(decibels / -20.0)),
        None => number(word),
    };
    rmse.filter(|rmse| *rmse > 0.0 && *rmse < 1.0)
        .ok_or_else(|| {
            "expected decibels such as 55dB, or an RMSE between 0 and 1 such as 0.002".to_owned()
        })
}

/// Parses a time such as `16ms` or `2s`; a number alone is in milliseconds.
pub fn parse_time(word: &str) -> Result<Duration, String> {
    let word = word.to_ascii_lowercase();
    let (number, millis) = if let Some(millis) = word.strip_suffix("ms") {
        (millis, 1.0)
    } else if let Some(seconds) = word.strip_suffix('s') {
        (seconds, 1e3)
    } else {
        (&*word, 1.0)
    };
    let millis = number.trim().parse::<f64>().ok().map(|n| n * millis);
    let time = millis.and_then(|millis| Duration::try_from_secs_f64(millis / 1e3).ok());
    time.ok_or_else(|| "expected a time such as 16ms or 2s".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_and_times_have_their_units() {
        assert!((parse_error("60dB").expect("decibels") - 1e-3).abs() < 1e-12);
        assert_eq!(parse_error("0.002"), Ok(0.002));
        assert_eq!(parse_time("16ms"), Ok(Duration::from_millis(16)));
        assert_eq!(parse_time("2 s"), Ok(Duration::from_secs(2)));
        assert_eq!(parse_time("4"), Ok(Duration::from_millis(4)));
        assert_eq!(parse_time("16MS"), Ok(Duration::from_millis(16)));
        for wrong in ["", "dB", "nan", "-1", "0", "infdB", "55", "0dB", "-5dB"] {
            assert!(parse_error(wrong).is_err(), "{wrong}");
        }
        for wrong in ["", "ms", "-1ms", "nan", "1e30s", "16min"] {
            assert!(parse_time(wrong).is_err(), "{wrong}");
        }
    }
}

//! Camera paths as text: RON for Glint, and comma-separated values for other programs.

use std::fmt::Write as _;

use glam::DVec3;

use super::path::unwound;
use crate::scene::{
    Camera, Document, Key, MAX_SECONDS, Orientation, Projection, SAME_TIME, SceneError,
    format_number, header,
};

const HEAD: &str = "time,x,y,z,yaw,pitch,roll,projection,projection_distance,orthographic_height";
/// The columns that a table must have.
const REQUIRED: [&str; 4] = ["time", "x", "y", "z"];

/// Why a text is not a valid path.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct TableError {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong and what was expected.
    pub what: String,
}

/// Writes a path as comma-separated values, one line per camera, in seconds, world units and degrees.
pub fn to_table<'c>(cameras: impl IntoIterator<Item = (f64, &'c Camera)>) -> String {
    let mut text = format!("{HEAD}\n");
    let cameras: Vec<_> = cameras.into_iter().collect();
    let angles = cameras.iter().map(|(_, camera)| Orientation::of(camera));
    // Angles are unwound, so that readers can interpolate between lines across full turns.
    let angles = unwound(angles.map(|angles| (angles, 0.0))).into_iter();
    for ((time, camera), Orientation { yaw, pitch, roll }) in cameras.into_iter().zip(angles) {
        let [x, y, z] = camera.position.to_array();
        let degrees = [yaw, pitch, roll].map(f64::to_degrees);
        let numbers = [time, x, y, z, degrees[0], degrees[1], degrees[2]];
        let numbers = numbers.map(format_number).join(",");
        let _ = writeln!(
            text,
            "{numbers},{:?},{},{}",
            camera.projection, camera.projection_distance, camera.orthographic_height
        );
    }
    text
}

/// Returns the delimiter between cells: spreadsheets use semicolons where numbers have a decimal comma, and tabs on
/// clipboards.
fn delimiter_of(text: &str) -> u8 {
    let head = text.lines().next().unwrap_or_default();
    let mut delimiters = [',', ';', '\t'].into_iter();
    delimiters
        .find(|&delimiter| head.contains(delimiter))
        .map_or(b',', |delimiter| delimiter as u8)
}

fn number_of(cell: &str, delimiter: u8) -> Option<f64> {
    match delimiter {
        b',' => cell.parse().ok(),
        _ => cell.replacen(',', ".", 1).parse().ok(),
    }
}

/// Reads keys from such a table, or from one with semicolons and decimal commas. The first line names the columns,
/// in any order; `time`, `x`, `y` and `z` are required, other missing values are taken from `like`.
///
/// # Errors
/// [`TableError`], with the line.
pub fn from_table(text: &str, like: &Camera) -> Result<Vec<Key<Camera>>, TableError> {
    let text = text.trim_start_matches('\u{feff}');
    // There may be blank lines before the column names.
    let is_blank = |line: &str| line.trim().is_empty();
    let blank: Vec<&str> = text
        .split_inclusive('\n')
        .take_while(|line| is_blank(line))
        .collect();
    let text = &text[blank.iter().map(|line| line.len()).sum()..];
    let fail = |line: usize, what: String| TableError {
        line: line + blank.len(),
        what,
    };
    let delimiter = delimiter_of(text);
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .flexible(true)
        .delimiter(delimiter)
        .from_reader(text.as_bytes());
    let names = reader.headers().cloned().unwrap_or_default();
    if names.is_empty() {
        return Err(fail(1, format!("the file is empty; expected {HEAD}")));
    }
    let column = |name: &str| {
        let mut names = names.iter();
        names.position(|other| other.eq_ignore_ascii_case(name))
    };
    if let Some(missing) = REQUIRED.iter().find(|name| column(name).is_none()) {
        let what = format!("there is no column {missing}; expected {HEAD}");
        return Err(fail(1, what));
    }
    let mut keys: Vec<(usize, Key<Camera>)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| fail(1, error.to_string()))?;
        let line = record.position().map_or(1, |place| place.line() as usize);
        let cell = |name: &str| record.get(column(name)?).filter(|cell| !cell.is_empty());
        let number = |name: &'static str, default: f64| match cell(name) {
            None if REQUIRED.contains(&name) => Err(fail(line, format!("{name} is missing"))),
            None => Ok(default),
            Some(cell) => match number_of(cell, delimiter) {
                Some(number) if number.is_finite() => Ok(number),
                _ => {
                    let what = format!("{name} must be a number, found {cell:?}");
                    Err(fail(line, what))
                }
            },
        };
        let own = Orientation::of(like);
        let angle = |name, own: f64| number(name, own.to_degrees()).map(f64::to_radians);
        let angles = Orientation {
            yaw: angle("yaw", own.yaw)?,
            pitch: angle("pitch", own.pitch)?,
            roll: angle("roll", own.roll)?,
        };
        let projection = match cell("projection") {
            None => like.projection,
            Some(word) if word.eq_ignore_ascii_case("perspective") => Projection::Perspective,
            Some(word) if word.eq_ignore_ascii_case("orthographic") => Projection::Orthographic,
            Some(other) => {
                let expected = "projection must be Perspective or Orthographic";
                return Err(fail(line, format!("{expected}, found {other:?}")));
            }
        };
        let camera = Camera {
            position: DVec3::new(number("x", 0.0)?, number("y", 0.0)?, number("z", 0.0)?),
            projection,
            projection_distance: number("projection_distance", like.projection_distance)?,
            orthographic_height: number("orthographic_height", like.orthographic_height)?,
            ..like.clone()
        };
        let time = number("time", 0.0)?;
        if !(0.0..=MAX_SECONDS).contains(&time) {
            let time = format_number(time);
            let expected = format!("time must be between 0 and {MAX_SECONDS}");
            return Err(fail(line, format!("{expected}, found {time}")));
        }
        let key = Key::new(time, angles.apply(&camera));
        keys.push((line, key));
    }
    // The lines may be in any order.
    keys.sort_by(|(_, a), (_, b)| a.time.total_cmp(&b.time));
    let mut pairs = keys.array_windows();
    if let Some([_, (line, key)]) = pairs.find(|[a, b]| b.1.time - a.1.time < SAME_TIME) {
        let time = format_number(key.time);
        let what = format!("there are two lines for the time {time}");
        return Err(fail(*line, what));
    }
    Ok(keys.into_iter().map(|(_, key)| key).collect())
}

/// Writes a path in RON: the list of keys as in the scene file, one key per line.
///
/// # Errors
/// Any serialization error; no path is known for which this happens.
pub fn to_text(keys: &[Key<Camera>]) -> Result<String, ron::Error> {
    let config = ron::ser::PrettyConfig::new()
        .struct_names(true)
        .depth_limit(1)
        .new_line("\n");
    let text = ron::ser::to_string_pretty(keys, config)?;
    Ok(text + "\n")
}

/// Reads keys from such a text, or the camera keys of a whole scene file.
///
/// # Errors
/// [`TableError`], with the line.
pub fn from_text(text: &str) -> Result<Vec<Key<Camera>>, TableError> {
    let text = text.trim_start_matches('\u{feff}');
    let is_list = text[header(text).len()..].trim_start().starts_with('[');
    if !is_list {
        let document = Document::from_text(text).map_err(|error| match error {
            SceneError::Refused(refusal) => TableError {
                line: refusal.line,
                what: refusal.sentence,
            },
            other => TableError {
                line: 1,
                what: other.to_string(),
            },
        })?;
        return Ok(document.scene.animation.keys.clone());
    }
    let keys: Result<Vec<Key<Camera>>, _> = ron::from_str(text);
    let mut keys = keys.map_err(|error| TableError {
        line: error.span.start.line,
        what: error.code.to_string(),
    })?;
    // The keys may be in any order, as in a table.
    keys.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(keys)
}

//! A job for a render farm: an Open Job Description template.
//!
//! <https://github.com/OpenJobDescription/openjd-specifications>, version 2023-09 with task chunking.

use super::sequence::Sequence;

/// Frames that one task makes, unless the farm says otherwise.
const CHUNK: u32 = 10;

/// The template, with a name between @ signs for each value.
const TEMPLATE: &str = include_str!("../../assets/job_template.yaml");

/// The template: frames in chunks, then a video of all of them. The scene is an attached file, which
/// lies beside the template under the name `scene`; `name` is what the job is called.
pub fn job_template(sequence: &Sequence, name: &str, scene: &str) -> String {
    // A JSON text in quotation marks is a YAML one too.
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let (width, height) = sequence.size();
    let values = [
        ("@NAME@", quoted(name)),
        ("@SCENE@", quoted(scene)),
        ("@FRAMES@", quoted(&sequence.frames.to_string())),
        ("@PATTERN@", quoted(&sequence.pattern.text())),
        ("@FORMAT@", quoted(sequence.format.ending())),
        ("@WIDTH@", width.to_string()),
        ("@HEIGHT@", height.to_string()),
        ("@ANTIALIAS@", quoted(&sequence.antialias())),
        ("@CHUNK@", CHUNK.to_string()),
    ];
    let place_of = |rest: &str| {
        let places = values.iter().filter_map(|(key, value)| {
            let at = rest.find(key)?;
            Some((at, *key, value.clone()))
        });
        places.min_by_key(|(at, ..)| *at)
    };
    // What was put in is not looked at again: a scene may be called anything.
    let (mut text, mut rest) = (String::new(), TEMPLATE);
    while let Some((at, key, value)) = place_of(rest) {
        text.push_str(&rest[..at]);
        text.push_str(&value);
        rest = &rest[at + key.len()..];
    }
    text + rest
}

//! Randomly damaged text through every entry point for text: what is accepted is valid, and nothing panics. A short
//! run by default; `GLINT_FUZZ=10000000` sets the number of texts per entry point, and `GLINT_DOOR=paths` selects
//! one of them. Mesh files are fuzzed in `src/mesh/tests/mutated.rs`: `PROPTEST_CASES=1000000`.

use std::panic::catch_unwind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use glint::animate::{from_table, from_text, to_table, to_text};
use glint::export::{Frames, Hash, Manifest, Pattern};
use glint::plan::RenderRequest;
use glint::scene::{
    Camera, Document, EXAMPLES, Example, Method as _, RayOffset, Sampling, Scene, check,
};

use crate::pictures::picture;
use crate::random::Dice;
use crate::scenes::files_in;

/// Number of texts per entry point, unless the environment asks for more.
const FEW: u64 = 2000;
/// Scenes with longer texts are left out: most damage to them would hit numbers.
const LONGEST: usize = 6000;

/// Maximum number of keys, objects or lights in a seed; more would only make each text slower.
const ENOUGH: usize = 4;

/// How many of the first [`WORDS`] are numbers.
const NUMBERS: usize = 18;
/// Words that break more than random bytes do.
const WORDS: [&str; 40] = [
    "1",
    "2.5",
    "-7",
    "100",
    "255",
    "3e4",
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "-0.0",
    "1e-320",
    "1e308",
    "1e999",
    "4294967295",
    "18446744073709551616",
    "0x7f",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "\\",
    ",",
    ":",
    "//",
    "/*",
    "\n",
    "\t",
    "é",
    "\u{feff}",
    "Some(",
    "None",
    "Mesh(points: [(0,0,0),(1,0,0),(0,1,0)], faces: [(0,1,2)])",
    "Mesh(file: \"../a.ply\")",
    "Animation(",
    "\u{0}",
];

/// An entry point for text: its name, and valid texts to start from.
struct Door {
    name: &'static str,
    seeds: Vec<String>,
    /// Parses a text; returns whether it was accepted.
    enter: fn(&str) -> bool,
}

fn pick(dice: &mut Dice, count: usize) -> usize {
    (dice.real(0.0, count as f64) as usize).min(count - 1)
}

/// Damages a text in one to six places.
fn damaged(seed: &str, other: &str, dice: &mut Dice) -> String {
    let mut bytes = seed.as_bytes().to_vec();
    // Half of the texts are damaged once: with more damage, they are seldom accepted.
    for _ in 0..=pick(dice, 2) * pick(dice, 6) {
        let at = pick(dice, bytes.len() + 1);
        let end = (at + pick(dice, 40)).min(bytes.len());
        let word = WORDS[pick(dice, WORDS.len())].as_bytes();
        match pick(dice, 9) {
            0 => bytes
                .splice(at..end.min(at + 1), [dice.real(0.0, 256.0) as u8])
                .for_each(drop),
            1 => bytes.splice(at..at, word.iter().copied()).for_each(drop),
            2 => bytes.splice(at..end, word.iter().copied()).for_each(drop),
            3 => bytes.drain(at..end).for_each(drop),
            4 => bytes.extend_from_within(at..end),
            5..8 => number(&mut bytes, at, WORDS[pick(dice, NUMBERS)].as_bytes()),
            _ => {
                let from = pick(dice, other.len());
                let part = other.as_bytes()[from..].iter().take(80);
                bytes.splice(at..at, part.copied()).for_each(drop);
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Replaces the next number by a word.
fn number(bytes: &mut Vec<u8>, at: usize, word: &[u8]) {
    let is_number = |byte: &u8| byte.is_ascii_digit() || b".-".contains(byte);
    let Some(start) = bytes[at..].iter().position(is_number).map(|skip| at + skip) else {
        return;
    };
    let length = bytes[start..]
        .iter()
        .take_while(|byte| is_number(byte))
        .count();
    bytes
        .splice(start..start + length, word.iter().copied())
        .for_each(drop);
}

/// An accepted scene passes the check, survives being written and read again, and can be rendered.
fn enter_scene(text: &str) -> bool {
    let Ok(document) = Document::from_text(text) else {
        return false;
    };
    assert_eq!(check(&document.scene), Ok(()));
    let again = document.to_text().expect("a text");
    assert_eq!(Document::from_text(&again).expect("a scene"), document);
    let request = RenderRequest {
        sampling: Sampling::ADAPTIVE,
        ..RenderRequest::of(&document.scene, 12, 9)
    };
    let (drawn, _) = picture(&document.scene, &request);
    assert_eq!(drawn.pixels.len(), 12 * 9);
    true
}

fn enter_path(text: &str) -> bool {
    let Ok(keys) = from_table(text, &Camera::default()).or(from_text(text)) else {
        return false;
    };
    // Further checks are made on the scene that the path becomes part of.
    let again = to_text(&keys).expect("a text");
    from_text(&again).is_ok()
}

fn enter_manifest(text: &str) -> bool {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("glint-frames.txt"), text).expect("written");
    let manifest = Manifest::read(folder.path()).expect("it can be read");
    let nobody = Hash::from_bytes([7; 32]);
    assert!(!manifest.is_valid("frame_0001.ppm", &nobody));
    true
}

fn enter_words(text: &str) -> bool {
    let frames = Frames::parse(text);
    if let Ok(frames) = &frames {
        assert_eq!(Frames::parse(&frames.to_string()).as_ref(), Ok(frames));
    }
    let pattern = Pattern::parse(text);
    if let Ok(pattern) = &pattern {
        assert!(!pattern.name(7).contains(['/', '\0']), "{text:?}");
    }
    let sampling = Sampling::parse(text);
    if let Ok(sampling) = sampling {
        assert_eq!(Sampling::parse(&sampling.id()), Ok(sampling));
    }
    let offset = RayOffset::parse(text);
    if let Ok(offset) = offset {
        assert_eq!(RayOffset::parse(&offset.id()), Ok(offset));
    }
    frames.is_ok() || pattern.is_ok() || sampling.is_ok() || offset.is_ok()
}

/// The same scene with only a few things of each kind, in which nothing but the camera moves.
fn small(mut document: Document) -> Document {
    let Scene {
        objects, lights, ..
    } = &mut document.scene;
    objects.truncate(ENOUGH);
    lights.truncate(ENOUGH / 2);
    let of_objects = objects.iter().map(|object| object.color_pack.clone());
    let markers = lights.iter().filter_map(|light| light.marker.as_ref());
    let of_markers = markers.map(|marker| marker.color_pack.clone());
    let used: Vec<String> = of_objects.chain(of_markers).collect();
    let packs = document.scene.packs_mut();
    packs.retain(|name, _| used.contains(name));
    let animation = document.scene.animation_mut();
    animation.keys.truncate(ENOUGH / 2);
    animation.tracks.clear();
    animation.take = None;
    document
}

fn doors() -> Vec<Door> {
    let flight = EXAMPLES
        .iter()
        .find(|example| example.name.contains("light"));
    let keys = flight.map_or(Vec::new(), |flight| {
        let keys = flight.document().scene.animation.keys.clone();
        keys.into_iter().take(ENOUGH).collect()
    });
    let table = to_table(keys.iter().map(|key| (key.time, &key.value)));
    let note = format!(
        "# Frames\nframe_0001.ppm\t{0}\t{0}\t1.5\nframe_0002.ppm\t{0}\t{0}\t1.5\n",
        "ab".repeat(32)
    );
    let bad = files_in("tests/it/bad_scenes");
    let bad = bad
        .iter()
        .filter_map(|path| std::fs::read_to_string(path).ok());
    let bad: Vec<String> = bad.collect();
    let examples = EXAMPLES.iter().map(Example::document);
    let small = examples.clone().map(|example| small(example).to_text());
    // As many valid seeds as invalid ones: a text that is already invalid is seldom accepted after damage.
    let small = small.flatten().cycle().take(bad.len());
    let scenes = examples.flat_map(|example| example.to_text());
    let scenes = scenes.filter(|text| text.len() < LONGEST);
    let words = [
        "1-10:3,20",
        "frame_####.png",
        "adaptive:0.1:2",
        "relative:0.01",
    ];
    vec![
        Door {
            name: "scenes",
            seeds: small.chain(bad.clone()).chain(scenes).collect(),
            enter: enter_scene,
        },
        Door {
            name: "paths",
            seeds: vec![table, to_text(&keys).expect("a text")],
            enter: enter_path,
        },
        Door {
            name: "manifests",
            seeds: vec![note],
            enter: enter_manifest,
        },
        Door {
            name: "words",
            seeds: words.map(str::to_owned).to_vec(),
            enter: enter_words,
        },
    ]
}

#[test]
fn no_door_lets_in_what_is_broken_or_breaks_itself() {
    let texts = std::env::var("GLINT_FUZZ").ok();
    let texts: u64 = texts.and_then(|count| count.parse().ok()).unwrap_or(FEW);
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let only = std::env::var("GLINT_DOOR").ok();
    let is_asked = |door: &Door| only.as_ref().is_none_or(|name| name == door.name);
    let asked: Vec<Door> = doors().into_iter().filter(is_asked).collect();
    assert!(!asked.is_empty(), "there is no door {only:?}");
    for door in asked {
        let start = Instant::now();
        let (longest, let_in) = (AtomicU64::new(0), AtomicU64::new(0));
        std::thread::scope(|scope| {
            for thread in 0..threads {
                let (door, longest, let_in) = (&door, &longest, &let_in);
                scope.spawn(move || {
                    for number in (thread..texts).step_by(threads as usize) {
                        let dice = &mut Dice(number.wrapping_mul(0x9E37_79B9) + 11);
                        let seeds = &door.seeds;
                        let (seed, other) = (pick(dice, seeds.len()), pick(dice, seeds.len()));
                        let text = damaged(&seeds[seed], &seeds[other], dice);
                        let start = Instant::now();
                        let entered = catch_unwind(|| (door.enter)(&text));
                        let is_in = entered.unwrap_or_else(|_| panic!("{}: {text:?}", door.name));
                        let_in.fetch_add(u64::from(is_in), Ordering::Relaxed);
                        let micros = start.elapsed().as_micros() as u64;
                        if longest.fetch_max(micros, Ordering::Relaxed) < micros
                            && micros > 1_000_000
                        {
                            println!("{}: {micros} µs for {text:?}", door.name);
                        }
                    }
                });
            }
        });
        // Damage that is never accepted would test nothing but the parser.
        assert!(
            let_in.load(Ordering::Relaxed) * 200 > texts,
            "{}",
            door.name
        );
        println!(
            "{}: {texts} texts, {} of them let in, in {:.1} s, the longest took {} ms",
            door.name,
            let_in.load(Ordering::Relaxed),
            start.elapsed().as_secs_f64(),
            longest.into_inner() / 1000
        );
    }
}

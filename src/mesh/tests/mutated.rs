//! Good files with random damage: each is read or refused without a panic.

use proptest::prelude::*;

use super::solid::all;
use super::{Sample, read_triangles};

/// Strings that are more likely to break a file than random bytes.
const WORDS: [&str; 12] = [
    "nan",
    "-1",
    "1e999",
    "0",
    "4294967295",
    "-9223372036854775808",
    "\n",
    "\\\n",
    "\"",
    "[",
    "é",
    "solid ",
];

#[derive(Clone, Debug)]
enum Damage {
    Byte(usize, u8),
    Word(usize, usize),
    Cut(usize),
    Remove(usize, usize),
    Repeat(usize, usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    let place = 0..4000_usize;
    prop_oneof![
        4 => (place.clone(), any::<u8>()).prop_map(|(at, byte)| Damage::Byte(at, byte)),
        4 => (place.clone(), 0..WORDS.len()).prop_map(|(at, word)| Damage::Word(at, word)),
        1 => place.clone().prop_map(Damage::Cut),
        2 => (place.clone(), 1..40_usize).prop_map(|(at, length)| Damage::Remove(at, length)),
        2 => (place, 1..40_usize).prop_map(|(at, length)| Damage::Repeat(at, length)),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    let (Damage::Byte(at, _)
    | Damage::Word(at, _)
    | Damage::Cut(at)
    | Damage::Remove(at, _)
    | Damage::Repeat(at, _)) = *damage;
    let at = at % (bytes.len() + 1);
    let end = |length: usize| (at + length).min(bytes.len());
    match *damage {
        Damage::Byte(_, byte) => bytes.splice(at..end(1), [byte]).for_each(drop),
        Damage::Word(_, word) => {
            let word = WORDS[word].as_bytes();
            bytes
                .splice(at..end(word.len()), word.iter().copied())
                .for_each(drop);
        }
        Damage::Cut(_) => bytes.truncate(at),
        Damage::Remove(_, length) => bytes.drain(at..end(length)).for_each(drop),
        Damage::Repeat(_, length) => bytes.extend_from_within(at..end(length)),
    }
}

/// Eight times the usual number of cases; set `PROPTEST_CASES` for more.
fn config() -> ProptestConfig {
    let config = ProptestConfig::default();
    ProptestConfig {
        failure_persistence: None,
        cases: 8 * config.cases,
        ..config
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn damage_is_refused_or_harmless(
        kind in 0..8_usize,
        damages in prop::collection::vec(damage(), 1..6),
    ) {
        let (name, mut bytes) = all().swap_remove(kind);
        for damage in &damages {
            apply(&mut bytes, damage);
        }
        let sample = Sample::new(name, bytes);
        match read_triangles(&sample.path) {
            Ok(mesh) => {
                prop_assert!(!mesh.faces().is_empty());
                prop_assert!(mesh.points().iter().all(|point| point.is_finite()));
                let count = mesh.points().len() as u32;
                prop_assert!(mesh.faces().as_flattened().iter().all(|&index| index < count));
            }
            Err(error) => {
                let said = error.to_string();
                prop_assert!(!said.contains('\n') && said.len() < 400, "{said}");
            }
        }
    }

    #[test]
    fn damaged_colors_are_left_out(damages in prop::collection::vec(damage(), 1..6)) {
        let text = "mtllib m.mtl\nusemtl a\n".to_owned() + &super::solid::obj();
        let sample = Sample::new("m.obj", text);
        let colors = "newmtl a\nKa 1 1 1\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 10\nillum 2\nmap_Kd a.png\nnewmtl b\nKd 1 0 0\n";
        let mut bytes = colors.as_bytes().to_vec();
        for damage in &damages {
            apply(&mut bytes, damage);
        }
        sample.beside("m.mtl", bytes);
        let parts = sample.parts();
        prop_assert_eq!(parts.len(), 1);
        if let Some(colors) = &parts[0].colors {
            let channels = colors.specular.iter().flatten().chain(&colors.diffuse);
            prop_assert!(channels.into_iter().all(|channel| (0.0..=1.0).contains(channel)));
            let exponent = colors.exponent.unwrap_or(0.0);
            prop_assert!(exponent.is_finite() && exponent >= 0.0);
        }
    }
}

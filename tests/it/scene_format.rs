//! Compares the description of the scene format with the parser: every field is documented, with its actual default
//! and the values that are accepted.

use glint::scene::{Document, Scene};

const TEXT: &str = include_str!("../../assets/scene_format.md");

/// A row of a table.
struct Row {
    field: String,
    /// The documented default, if it can be written as a value.
    default: Option<String>,
    /// A value to write if the field is mandatory.
    sample: Option<String>,
    must_be: String,
}

/// A table: the type it describes, and its rows.
struct Table {
    name: String,
    rows: Vec<Row>,
}

/// The text between the first two backticks.
fn quoted(cell: &str) -> Option<String> {
    cell.split('`').nth(1).map(str::to_owned)
}

fn row(line: &str) -> Option<Row> {
    let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
    let [field, default, must_be, _] = cells[..] else {
        return None;
    };
    let is_sample = default.starts_with("such as");
    Some(Row {
        field: quoted(field)?,
        default: quoted(default).filter(|_| !is_sample),
        sample: quoted(default).filter(|_| is_sample),
        must_be: must_be.to_owned(),
    })
}

fn tables() -> Vec<Table> {
    let sections = TEXT.split("\n## ").skip(1);
    let table = |section: &str| Table {
        name: section.lines().next().unwrap_or_default().to_owned(),
        rows: section.lines().filter_map(row).collect(),
    };
    sections.map(table).collect()
}

/// A scene file that contains one value of a type with these fields.
fn file(kind: &str, fields: &str) -> String {
    let own = format!("{kind}({fields})");
    let object = |shape: &str| {
        format!("objects: [Object(name: \"Thing\", color_pack: \"pack 1\", shape: {shape})]")
    };
    let packs = "color_packs: {\"pack 1\": ColorPack(), \"light\": ColorPack()}";
    let lamp = "Light(name: \"Light 1\", position: (0, 0, 0))";
    let inner = match kind {
        "Scene" => return format!("Scene({fields})"),
        "Camera" => format!("objects: [], camera: {own}"),
        "Bookmark" => format!("objects: [], bookmarks: [{own}]"),
        "ColorPack" => {
            return format!(
                "Scene(version: 1, objects: [], color_packs: {{\"pack 1\": {own}, \"light\": ColorPack()}})"
            );
        }
        "Object" => format!("objects: [{own}]"),
        "Sphere" | "Plane" | "Disc" | "Triangle" | "Mesh" => object(&own),
        "Light" => format!("objects: [], lights: [{own}]"),
        "LightObj" => format!(
            "objects: [], lights: [Light(name: \"Lamp\", position: (0, 0, 0), marker: {own})]"
        ),
        "Render" => format!("objects: [], render: {own}"),
        "Animation" => format!("objects: [], animation: {own}"),
        "Key" => format!("objects: [], animation: Animation(keys: [{own}])"),
        "Track" => {
            let things = "[Object(name: \"Thing\", color_pack: \"pack 1\", shape: Sphere(center: (0, 0, 0), radius: 1)), Object(name: \"Mesh\", color_pack: \"pack 1\", shape: Mesh(points: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], faces: [(0, 1, 2)]))]";
            format!("objects: {things}, lights: [{lamp}], animation: Animation(tracks: [{own}])")
        }
        other => panic!("no scene has a {other}"),
    };
    format!("Scene(version: 1, {packs}, {inner})")
}

fn read(text: &str) -> Result<Scene, String> {
    let document = Document::from_text(text);
    document
        .map(|document| document.scene)
        .map_err(|error| error.to_string())
}

impl Table {
    /// Reads a scene in which the field has this value; `None` omits it.
    fn with(&self, field: &str, value: Option<&str>) -> Result<Scene, String> {
        let needed = self.rows.iter().filter(|row| row.field != field);
        let needed = needed.filter_map(|row| Some((&row.field, row.sample.as_ref()?)));
        let mut fields: Vec<String> = needed
            .map(|(name, value)| format!("{name}: {value}"))
            .collect();
        fields.extend(value.map(|value| format!("{field}: {value}")));
        read(&file(&self.name, &fields.join(", ")))
    }

    fn assert_let_in(&self, row: &Row, value: &str) {
        let read = self.with(&row.field, Some(value));
        assert!(
            read.is_ok(),
            "{}.{}: {value}: {read:?}",
            self.name,
            row.field
        );
    }

    fn assert_refused(&self, row: &Row, value: &str) {
        let read = self.with(&row.field, Some(value));
        assert!(read.is_err(), "{}.{}: {value}", self.name, row.field);
    }
}

/// The limits of a range such as `0–1`.
fn range(must_be: &str) -> Option<(f64, f64)> {
    let numbers = must_be.split(',').next()?;
    let (low, high) = numbers.split_once('–')?;
    Some((low.parse().ok()?, high.parse().ok()?))
}

#[test]
fn every_field_is_described_and_no_other() {
    let tables = tables();
    assert_eq!(tables.len(), 16);
    for table in &tables {
        let error = table.with("no_such_field", Some("1")).expect_err("refused");
        let known = error.split_once("it has ").expect("the fields").1;
        let known = known.lines().next().unwrap_or_default();
        let mut known: Vec<&str> = known.split('`').skip(1).step_by(2).collect();
        let mut told: Vec<&str> = table.rows.iter().map(|row| &*row.field).collect();
        known.sort_unstable();
        told.sort_unstable();
        assert_eq!(told, known, "{}", table.name);
    }
}

#[test]
fn defaults_are_the_ones_that_are_told() {
    for table in tables() {
        for row in &table.rows {
            let without = table.with(&row.field, None);
            if let Some(default) = &row.default {
                let written = table.with(&row.field, Some(default));
                assert!(written.is_ok(), "{}.{}: {written:?}", table.name, row.field);
                assert_eq!(without, written, "{}.{}", table.name, row.field);
            } else if row.sample.is_some() {
                assert!(
                    without.is_err(),
                    "{}.{} can be left out",
                    table.name,
                    row.field
                );
            }
        }
    }
}

/// Values that the description of a field accepts, and values that it rejects; `None` if they cannot be tested.
fn examples(must_be: &str) -> Option<(Vec<String>, Vec<String>)> {
    let all = |values: &[&str]| values.iter().map(|value| (*value).to_owned()).collect();
    let told = |good: &[&str], bad: &[&str]| Some((all(good), all(bad)));
    if let Some((low, high)) = range(must_be) {
        let step = if must_be.contains("whole") { 1.0 } else { 1e-4 };
        let beyond = [low - step, high + high.abs() * step];
        let words = |numbers: [f64; 2]| numbers.map(|number| number.to_string()).to_vec();
        return Some((words([low, high]), words(beyond)));
    }
    match must_be {
        "above 0, at most 1e12" => told(&["1e-9", "1e12"], &["0", "1.1e12"]),
        "a colour" => told(
            &["(0, 0, 0)", "(255, 255, 255)"],
            &["(-0.1, 0, 0)", "(0, 0, 255.1)"],
        ),
        "a place" => told(&["(0.5, 1e3, -7)"], &["(0, 0, 1.1e12)", "(0, nan, 0)"]),
        "a direction" => told(&["(3, 1e6, 1e-6)"], &["(0, 0, 0)"]),
        "true or false" => told(&["true", "false"], &["1"]),
        "a name" => told(&["\"é 1\""], &["\" \"", "\"a\\u{7}\""]),
        "a factor from 1e-6 to 1e6, or three" => told(
            &["1e-6", "-1e6", "(1, -2, 3e5)"],
            &["0", "1.1e6", "1e-7", "(1, 0, 1)"],
        ),
        words if words.starts_with('`') => {
            let words: Vec<&str> = words.split('`').skip(1).step_by(2).collect();
            told(&words, &["\"nonsense\"", "Nonsense"])
        }
        _ => None,
    }
}

#[test]
fn what_a_field_must_be_is_let_in_and_nothing_beyond() {
    let mut tried = 0;
    // The values of a track are those of its target.
    for table in tables().iter().filter(|table| table.name != "Track") {
        for row in &table.rows {
            let Some((good, bad)) = examples(&row.must_be) else {
                continue;
            };
            for value in &good {
                table.assert_let_in(row, value);
            }
            for value in &bad {
                table.assert_refused(row, value);
            }
            tried += 1;
        }
    }
    assert!(tried >= 50, "only {tried} fields were tried");
}

#[test]
fn the_example_is_a_scene() {
    let example = TEXT
        .split("```ron\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    let scene = read(example.expect("an example")).expect("a scene");
    assert_eq!((scene.objects.len(), scene.lights.len()), (2, 1));
}

//! Differences between two scenes, described in words.

use std::collections::BTreeMap;

use super::whole::Scene;
use crate::words::{counted, listed};

/// Describes what changed from `scene` to `other`, one line per kind of change, such as `2 objects added: A, B`.
/// Empty for equal scenes.
pub fn differences(scene: &Scene, other: &Scene) -> Vec<String> {
    let mut lines = Vec::new();
    named(
        "object",
        scene.objects.iter().map(|object| (&object.name, object)),
        other.objects.iter().map(|object| (&object.name, object)),
        &mut lines,
    );
    named(
        "light",
        scene.lights.iter().map(|light| (&light.name, light)),
        other.lights.iter().map(|light| (&light.name, light)),
        &mut lines,
    );
    named(
        "color pack",
        scene.color_packs.iter(),
        other.color_packs.iter(),
        &mut lines,
    );
    let parts = [
        ("the camera", scene.camera != other.camera),
        ("the animation", scene.animation != other.animation),
        ("the background", scene.background != other.background),
        (
            "the ambient intensity",
            scene.ambient_intensity != other.ambient_intensity,
        ),
        (
            "the visibility of light markers",
            scene.light_visualization != other.light_visualization,
        ),
        ("bookmarks", scene.bookmarks != other.bookmarks),
        ("picture settings", scene.render != other.render),
    ];
    for (part, _) in parts.iter().filter(|(_, is_other)| *is_other) {
        lines.push(format!("{part} changed"));
    }
    if lines.is_empty() && scene != other {
        lines.push("the order changed".to_owned());
    }
    lines
}

/// Appends a line each for the added, removed and changed items, which are identified by name.
fn named<'a, T: PartialEq + 'a>(
    one: &str,
    before: impl Iterator<Item = (&'a String, &'a T)>,
    after: impl Iterator<Item = (&'a String, &'a T)>,
    lines: &mut Vec<String>,
) {
    let before: BTreeMap<_, _> = before.collect();
    let after: BTreeMap<_, _> = after.collect();
    let added = after.keys().filter(|name| !before.contains_key(*name));
    let removed = before.keys().filter(|name| !after.contains_key(*name));
    let changed = after
        .iter()
        .filter(|(name, thing)| before.get(*name).is_some_and(|old| old != *thing))
        .map(|(name, _)| name);
    let added: Vec<_> = added.collect();
    let removed: Vec<_> = removed.collect();
    let changed: Vec<_> = changed.collect();
    for (what, names) in [("added", added), ("removed", removed), ("changed", changed)] {
        let count = counted(names.len(), one);
        let named = listed(names.into_iter().map(|name| (*name).clone()));
        lines.extend(named.map(|named| format!("{count} {what}: {named}")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_named() {
        let scene = Scene::demo();
        assert!(differences(&scene, &scene).is_empty());
        let mut other = scene.clone();
        other.objects[0].visible = false;
        other.lights[1].name = "Lamp".to_owned();
        other.camera.position.x += 1.0;
        let lines = differences(&scene, &other);
        assert_eq!(
            lines[0],
            format!("1 object changed: {}", scene.objects[0].name)
        );
        assert_eq!(lines[1], "1 light added: Lamp");
        assert!(lines[2].starts_with("1 light removed: "));
        assert_eq!(lines[3], "the camera changed");
        // These are also reported next to other differences.
        let mut dimmed = scene.clone();
        dimmed.ambient_intensity *= 0.5;
        dimmed.background.x += 1.0;
        dimmed.render.width += 1;
        let lines = [
            "picture settings changed",
            "the background changed",
            "the ambient intensity changed",
        ];
        let mut found = differences(&scene, &dimmed);
        found.sort_unstable();
        let mut expected = lines.map(str::to_owned);
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
}

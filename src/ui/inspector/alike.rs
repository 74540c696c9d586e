//! Applying a change of one item to several.

use std::collections::BTreeSet;

use glam::DVec3;

use super::items::{BOTH_COLORS, COLOR_PACK};
use crate::editor::{Edit, Item, ItemKind};
use crate::scene::{ColorPack, Light, Object, Scene, Shape};
use crate::ui::rows::{EditedPart, is_channel};

/// A point of an item that an edit moves.
struct MovedPoint {
    from: DVec3,
    to: DVec3,
    /// Whether it is the item's only point and thus its position, not one of several corners.
    is_only: bool,
}

fn moved_point(scene: &Scene, edit: &Edit) -> Option<MovedPoint> {
    match edit {
        Edit::Object(index, new, _) => {
            let (old, new) = (&scene.objects.get(*index)?.shape, &new.shape);
            let (old, new) = (old.points(), new.points());
            let mut pairs = old.iter().zip(&new);
            let (from, to) = pairs.find(|(from, to)| from != to)?;
            Some(MovedPoint {
                from: *from,
                to: *to,
                is_only: old.len() == 1,
            })
        }
        Edit::Light(index, new, _) => {
            let old = scene.lights.get(*index)?;
            (old.position != new.position).then_some(MovedPoint {
                from: old.position,
                to: new.position,
                is_only: true,
            })
        }
        _ => None,
    }
}

/// Moves all selected items with the last one, whose point is moved by `edit`: together by the same offset, or, if
/// not `is_together`, to the coordinates that were typed.
fn move_all(
    scene: &Scene,
    selected: &[Item],
    (edit, point): (Edit, &MovedPoint),
    is_together: bool,
) -> Edit {
    let moved = |position: DVec3| {
        if is_together {
            position + (point.to - point.from)
        } else {
            with_changed_coordinates(position, point.from, point.to)
        }
    };
    // If the point is one of several corners, its item is moved as a whole, too.
    let (moved_items, last_edit) = match selected.split_last() {
        Some((_, moved_items)) if point.is_only => (moved_items, Some(edit)),
        _ => (selected, None),
    };
    let edits = moved_items.iter().filter_map(|item| {
        let object = |object: &mut Object| {
            // Typed coordinates are those of a single point, which shapes with several points do not have.
            if is_together || object.shape.points().len() == 1 {
                object.shape = object.shape.placed(moved(object.shape.position()));
            }
        };
        let light = |light: &mut Light| light.position = moved(light.position);
        Edit::of_item(scene, *item, "position", (object, light))
    });
    let edits = edits.chain(last_edit).collect();
    Edit::Each(edits, format!("Move {} items", selected.len()))
}

/// Returns the edit that applies a change of the last selected item to all; `is_together` says whether positions
/// are moved by the same offset.
pub fn for_all(scene: &Scene, selected: &[Item], edit: Edit, is_together: bool) -> Edit {
    if let Some(point) = moved_point(scene, &edit).filter(|point| is_together || point.is_only) {
        return move_all(scene, selected, (edit, &point), is_together);
    }
    let count = selected.len();
    let (edits, field): (Vec<Edit>, &str) = match edit {
        Edit::Object(index, new, field) => {
            let Some(old) = scene.objects.get(index) else {
                return Edit::Object(index, new, field);
            };
            let edits = selected
                .iter()
                .filter_map(|item| object_change_on(scene, *item, (old, &new), field));
            (edits.collect(), field)
        }
        Edit::Light(index, new, field) => {
            let Some(old) = scene.lights.get(index) else {
                return Edit::Light(index, new, field);
            };
            let edits = selected
                .iter()
                .filter_map(|item| light_change_on(scene, *item, (old, &new), field));
            (edits.collect(), field)
        }
        Edit::Pack(index, new, field) => {
            let Some((_, old)) = scene.color_packs.get_index(index) else {
                return Edit::Pack(index, new, field);
            };
            let edits = packs_of(scene, selected).filter_map(|index| {
                let (_, current) = scene.color_packs.get_index(index)?;
                let pack = with_pack_changes(current, (old, &new), field);
                Some(Edit::Pack(index, pack, field))
            });
            (edits.collect(), field)
        }
        Edit::MakePacksUnique(_) => {
            let objects = selected.iter().filter(|item| item.kind == ItemKind::Object);
            return Edit::MakePacksUnique(objects.map(|item| item.index).collect());
        }
        other => return other,
    };
    Edit::Each(edits, format!("{count} items: {field}"))
}

/// Returns the edit that gives all others the value chosen for the last selected item, which has it already.
pub fn chosen_for_all(
    scene: &Scene,
    selected: &[Item],
    (edit, EditedPart { field, part }): (Edit, EditedPart),
) -> Edit {
    // As if the last item had no value there, so that it counts as changed as well.
    let clear = |vector: &mut DVec3| match part {
        Some(part) => vector[part] = f64::NAN,
        None => *vector = DVec3::NAN,
    };
    let mut scene = scene.clone();
    match &edit {
        Edit::Object(index, ..) => {
            let mut object = scene.objects[*index].clone();
            if field == COLOR_PACK {
                object.color_pack.clear();
            }
            object.shape.fields(&mut |mut property| {
                if property.name == field {
                    property.value.with_vector(clear);
                }
            });
            scene.objects[*index] = object;
        }
        Edit::Light(index, ..) => {
            let light = &mut scene.lights[*index];
            match (field, &mut light.marker) {
                ("position", _) => clear(&mut light.position),
                ("intensity", _) => light.intensity = f64::NAN,
                ("radius", Some(marker)) => marker.radius = f64::NAN,
                (COLOR_PACK, Some(marker)) => marker.color_pack.clear(),
                _ => {}
            }
        }
        Edit::Pack(index, ..) => {
            if let Some((_, pack)) = scene.packs_mut().get_index_mut(*index) {
                let name = field.split(' ').next();
                match name.unwrap_or_default() {
                    "ambient" => clear(&mut pack.ambient),
                    "specular" => clear(&mut pack.specular),
                    "phong" => pack.phong_exponent = f64::NAN,
                    // The row that sets both shows the diffuse colour.
                    name if name == "diffuse" || name == BOTH_COLORS.0 => clear(&mut pack.diffuse),
                    _ => {}
                }
            }
        }
        _ => {}
    }
    for_all(&scene, selected, edit, false)
}

/// The selected color packs and those of the selected objects, each once.
pub fn packs_of(scene: &Scene, selected: &[Item]) -> impl Iterator<Item = usize> {
    let users = selected.iter().filter(|item| item.kind != ItemKind::Light);
    let packs = users.filter_map(|item| scene.color_packs.get_index_of(item.color_pack(scene)?));
    packs.collect::<BTreeSet<_>>().into_iter()
}

/// A color pack with the changes from `old` to `new` applied: a whole colour, or one channel of it.
fn with_pack_changes(
    current: &ColorPack,
    (old, new): (&ColorPack, &ColorPack),
    field: &str,
) -> ColorPack {
    let mut pack = current.clone();
    let is_channel = is_channel(field);
    let copy_color = |current: &mut DVec3, old: DVec3, new: DVec3| {
        *current = match is_channel {
            true => with_changed_coordinates(*current, old, new),
            false if old != new => new,
            false => *current,
        };
    };
    if field.starts_with(BOTH_COLORS.0) {
        // Ambient follows diffuse whatever it was before, as when a single pack is changed.
        copy_color(&mut pack.diffuse, old.diffuse, new.diffuse);
        pack.ambient = pack.diffuse;
    } else {
        copy_color(&mut pack.ambient, old.ambient, new.ambient);
        copy_color(&mut pack.diffuse, old.diffuse, new.diffuse);
        copy_color(&mut pack.specular, old.specular, new.specular);
    }
    copy_if_changed(
        &mut pack.phong_exponent,
        &old.phong_exponent,
        &new.phong_exponent,
    );
    copy_if_changed(&mut pack.reflective, &old.reflective, &new.reflective);
    pack
}

/// Copies a property if it has changed.
fn copy_if_changed<T: Clone + PartialEq>(target: &mut T, old: &T, new: &T) {
    if old != new {
        target.clone_from(new);
    }
}

/// The edit that applies the change of an object to another item.
fn object_change_on(
    scene: &Scene,
    item: Item,
    (old, new): (&Object, &Object),
    field: &'static str,
) -> Option<Edit> {
    let to_object = |object: &mut Object| {
        copy_if_changed(&mut object.color_pack, &old.color_pack, &new.color_pack);
        copy_if_changed(&mut object.visible, &old.visible, &new.visible);
        copy_shape_changes(&mut object.shape, &old.shape, &new.shape);
    };
    let to_light = |light: &mut Light| {
        copy_if_changed(&mut light.visible, &old.visible, &new.visible);
        if let Some(marker) = &mut light.marker {
            copy_if_changed(&mut marker.color_pack, &old.color_pack, &new.color_pack);
        }
    };
    Edit::of_item(scene, item, field, (to_object, to_light))
}

/// The edit that applies the change of a light to another item.
fn light_change_on(
    scene: &Scene,
    item: Item,
    (old, new): (&Light, &Light),
    field: &'static str,
) -> Option<Edit> {
    let to_object =
        |object: &mut Object| copy_if_changed(&mut object.visible, &old.visible, &new.visible);
    let to_light = |light: &mut Light| {
        copy_if_changed(&mut light.intensity, &old.intensity, &new.intensity);
        copy_if_changed(&mut light.visible, &old.visible, &new.visible);
        match (&mut light.marker, &old.marker, &new.marker) {
            (Some(marker), Some(old), Some(new)) => {
                copy_if_changed(&mut marker.radius, &old.radius, &new.radius);
                copy_if_changed(&mut marker.color_pack, &old.color_pack, &new.color_pack);
            }
            (marker @ None, None, Some(new)) => *marker = Some(new.clone()),
            (marker, Some(_), None) => *marker = None,
            _ => {}
        }
    };
    Edit::of_item(scene, item, field, (to_object, to_light))
}

/// `current` with the coordinates that differ between `old` and `new` taken from `new`.
fn with_changed_coordinates(current: DVec3, old: DVec3, new: DVec3) -> DVec3 {
    DVec3::select(new.cmpne(old), new, current)
}

/// All properties of a shape with their names; a single number fills all three coordinates.
pub fn values(shape: &Shape) -> Vec<(&'static str, DVec3)> {
    let mut values = Vec::new();
    shape.clone().fields(&mut |mut property| {
        let name = property.name;
        property
            .value
            .with_vector(|vector| values.push((name, *vector)));
    });
    values
}

/// Applies to a shape the changes from `old` to `new` of the properties that it has, too.
fn copy_shape_changes(shape: &mut Shape, old: &Shape, new: &Shape) {
    let (old, new) = (values(old), values(new));
    shape.fields(&mut |mut property| {
        let find = |values: &[(&str, DVec3)]| {
            let mut named = values.iter().filter(|(name, _)| *name == property.name);
            named.next().map(|(_, value)| *value)
        };
        if let Some((old, new)) = find(&old).zip(find(&new)) {
            let value = &mut property.value;
            value.with_vector(|vector| *vector = with_changed_coordinates(*vector, old, new));
        }
    });
}

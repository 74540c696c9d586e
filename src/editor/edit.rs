//! The changes that can be made to a scene, each with its name in the history.

use std::collections::{BTreeSet, HashSet};
use std::sync::Arc;

use glam::DVec3;

use crate::mesh::Part;
use crate::scene::{
    Animation, Bookmark, Camera, ColorPack, Easing, Interpolation, Keys, Light, List, Object,
    Owner, Render, Scene, Shape, Target,
};
use crate::words::{counted, listed};

use super::adding::{add_light, add_object, add_pack, duplicate, make_packs_unique};
use super::arrange::{Arrangement, arrange, group, move_within};
use super::clipboard::paste;
use super::item::{Item, ItemKind};

/// A change of the scene. The `&'static str` names the field that changed: edits of one field during one gesture are
/// one step in the undo history.
#[derive(Clone, Debug)]
pub enum Edit {
    /// Replaces the camera.
    Camera(Camera, &'static str),
    /// Sets the background colour, 0–255.
    Background(DVec3),
    /// Sets the ambient intensity, 0–1.
    Ambient(f64),
    /// Sets whether the markers of lights are visible.
    LightVisualization(bool),
    /// Replaces the settings of the still picture.
    Render(Render, &'static str),
    /// Replaces the animation; the name says what was done to its keys.
    Animation(Arc<Animation>, &'static str),
    /// Replaces the object at this index.
    Object(usize, Box<Object>, &'static str),
    /// Replaces the light at this index.
    Light(usize, Light, &'static str),
    /// Replaces the color pack at this index, which keeps its name.
    Pack(usize, ColorPack, &'static str),
    /// Adds an object of this name, with a number, and this shape.
    AddObject(&'static str, Shape),
    /// Adds the parts of a mesh file as objects.
    Import(Vec<Part>),
    /// Joins the triangles and meshes at these indices, in ascending order, into one mesh.
    Join(Vec<usize>),
    /// Adds everything in this scene; equal color packs are reused. The string is the name of the step.
    Paste(Box<Scene>, &'static str),
    /// Splits the mesh at this index into triangles.
    Separate(usize),
    /// Adds a light at this position.
    AddLight(DVec3),
    /// Adds a color pack.
    AddPack,
    /// Renames an item; references to it are updated.
    Rename(Item, String),
    /// Inserts a copy after the original in its list, and beside it in the scene.
    Duplicate(Item),
    /// Deletes these items; refused if a color pack among them stays in use.
    Delete(Vec<Item>),
    /// Moves these items, of one kind, to an index in their list, counted without them.
    Move(Vec<Item>, usize),
    /// Moves objects within their list, and into another group.
    Arrange(Arrangement),
    /// Gives each of these objects its own copy of its color pack.
    MakePacksUnique(Vec<usize>),
    /// Removes each color pack that equals an earlier one, which replaces it everywhere.
    MergePacks,
    /// Puts the objects at these indices into the group of this name; an empty name takes them out of their groups.
    Group(Vec<usize>, String),
    /// Renames a group, from the first name to the second, which no other group has.
    RenameGroup(String, String),
    /// Replaces the bookmarks; the name says what was done to them.
    Bookmarks(Vec<Bookmark>, &'static str),
    /// Applies all of these in turn, as one step of this name.
    Each(Vec<Edit>, String),
}

/// The reason why a change is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The color pack to be deleted is in use.
    #[error("“{name}” is used by {users}; give them another color pack first")]
    PackInUse {
        /// The pack's name.
        name: String,
        /// The first few names of what uses it, and how many more there are.
        users: String,
    },
    /// Two color packs would have the same name.
    #[error("There is another color pack named “{0}”; choose another name")]
    PackNameTaken(String),
    /// Two groups would become one.
    #[error("There is another group named “{0}”; choose another name, or drag its objects there")]
    GroupNameTaken(String),
}

/// What an edit overwrites, regardless of the value that the keys show at the time: indices of objects and of lights,
/// the ambient intensity, and the animation.
#[derive(Debug, Default)]
pub struct Replaced {
    objects: HashSet<usize>,
    lights: HashSet<usize>,
    ambient: bool,
    /// Whether the keys themselves are overwritten.
    pub animation: bool,
}

impl Replaced {
    fn add(&mut self, edit: &Edit) {
        match edit {
            Edit::Object(index, ..) => drop(self.objects.insert(*index)),
            Edit::Light(index, ..) => drop(self.lights.insert(*index)),
            Edit::Ambient(_) => self.ambient = true,
            Edit::Animation(..) => self.animation = true,
            Edit::Each(edits, _) => edits.iter().for_each(|edit| self.add(edit)),
            _ => {}
        }
    }

    /// Returns whether a target is overwritten that belongs to the light or object at index `index`.
    pub fn holds(&self, target: &Target, index: Option<usize>) -> bool {
        let owners = match target.owner() {
            None => return self.ambient,
            Some(Owner::Light(_)) => &self.lights,
            Some(Owner::Object(_)) => &self.objects,
        };
        index.is_some_and(|index| owners.contains(&index))
    }
}

impl Edit {
    /// Replaces the animation; `what` says what was done to its keys.
    pub fn animation(animation: Animation, what: &'static str) -> Self {
        Self::Animation(Arc::new(animation), what)
    }

    /// Deletes these keys of an animation.
    pub fn delete_keys(animation: &Animation, keys: &Keys) -> Self {
        Self::animation(animation.without_keys(keys), "Delete keys")
    }

    /// Sets the interpolation after these keys of an animation.
    pub fn key_interpolation(animation: &Animation, keys: &Keys, to: Interpolation) -> Self {
        let changed = animation.with_pace(keys, |(each, _)| *each = to);
        Self::animation(changed, "Key: interpolation")
    }

    /// Sets the easing after these keys of an animation.
    pub fn key_easing(animation: &Animation, keys: &Keys, to: Easing) -> Self {
        let changed = animation.with_pace(keys, |(_, each)| *each = to);
        Self::animation(changed, "Key: easing")
    }

    /// Replaces the object at this index; `field` names what changed.
    pub fn object(index: usize, object: Object, field: &'static str) -> Self {
        Self::Object(index, Box::new(object), field)
    }

    /// Indices of the objects that are joined or split, which keep the shape and place that is shown.
    pub fn joined(&self) -> &[usize] {
        match self {
            Self::Join(joined) => joined,
            Self::Separate(index) => std::slice::from_ref(index),
            _ => &[],
        }
    }

    /// Whether the edit moves the camera of the view.
    pub fn moves_view(&self) -> bool {
        match self {
            Self::Camera(..) => true,
            Self::Each(edits, _) => edits.iter().any(Self::moves_view),
            _ => false,
        }
    }

    /// Returns what the edit overwrites, regardless of keys.
    pub fn replaced(&self) -> Replaced {
        let mut replaced = Replaced::default();
        replaced.add(self);
        replaced
    }

    /// Shows or hides an item of `scene`, the scene as shown; `None` if it cannot be hidden.
    pub fn visible(scene: &Scene, item: Item, visible: bool) -> Option<Self> {
        let field = if visible { "show" } else { "hide" };
        let to_object = |object: &mut Object| object.visible = visible;
        let to_light = |light: &mut Light| light.visible = visible;
        Self::of_item(scene, item, field, (to_object, to_light))
    }

    /// Changes an object by `to_object`, or a light by `to_light`; `None` for color packs.
    pub fn of_item(
        scene: &Scene,
        Item { kind, index }: Item,
        field: &'static str,
        (to_object, to_light): (impl FnOnce(&mut Object), impl FnOnce(&mut Light)),
    ) -> Option<Self> {
        match kind {
            ItemKind::Object => {
                let mut object = scene.objects.get(index)?.clone();
                to_object(&mut object);
                Some(Self::object(index, object, field))
            }
            ItemKind::Light => {
                let mut light = scene.lights.get(index)?.clone();
                to_light(&mut light);
                Some(Self::Light(index, light, field))
            }
            ItemKind::Pack => None,
        }
    }

    /// The name of the step in the undo history.
    pub fn label(&self, scene: &Scene) -> String {
        let name = |item: Item| item.name(scene).unwrap_or_default().to_owned();
        let names = |items: &[Item]| match items {
            [item] => name(*item),
            _ => format!("{} items", items.len()),
        };
        match self {
            Self::Camera(_, field) => format!("Camera: {field}"),
            Self::Background(_) => "Background".to_owned(),
            Self::Ambient(_) => "Ambient intensity".to_owned(),
            Self::LightVisualization(true) => "Show light markers".to_owned(),
            Self::LightVisualization(false) => "Hide light markers".to_owned(),
            Self::Render(_, field) => format!("Render: {field}"),
            Self::Animation(_, what) | Self::Bookmarks(_, what) => (*what).to_owned(),
            Self::Object(index, _, field) => format!("{}: {field}", name(Item::object(*index))),
            Self::Light(index, _, field) => format!("{}: {field}", name(Item::light(*index))),
            Self::Pack(index, _, field) => format!("{}: {field}", name(Item::pack(*index))),
            Self::AddObject(name, _) => format!("Add {name}"),
            Self::Import(_) => "Import mesh".to_owned(),
            Self::Join(joined) => format!("Join {}", counted(joined.len(), "object")),
            Self::Paste(_, label) => (*label).to_owned(),
            Self::Separate(index) => format!("Separate {}", name(Item::object(*index))),
            Self::AddLight(_) => "Add Light".to_owned(),
            Self::AddPack => "Add ColorPack".to_owned(),
            Self::Rename(item, to) if to.is_empty() => format!("Rename {}", name(*item)),
            Self::Rename(item, to) => format!("Rename {} to {to}", name(*item)),
            Self::Duplicate(item) => format!("Duplicate {}", name(*item)),
            Self::Delete(items) => format!("Delete {}", names(items)),
            Self::Move(items, _) => format!("Move {}", names(items)),
            Self::Arrange(arrangement) => {
                let objects = arrangement.objects.iter().copied().map(Item::object);
                format!("Move {}", names(&objects.collect::<Vec<_>>()))
            }
            Self::MakePacksUnique(objects) => {
                let objects = objects.iter().copied().map(Item::object);
                format!("{}: own color pack", names(&objects.collect::<Vec<_>>()))
            }
            Self::MergePacks => "Merge equal packs".to_owned(),
            Self::RenameGroup(from, to) => format!("Rename {from} to {to}"),
            Self::Group(_, name) if name.is_empty() => "Ungroup".to_owned(),
            Self::Group(_, name) => format!("Group as {name}"),
            Self::Each(_, label) => label.clone(),
        }
    }

    /// Changes the scene; returns the items to be selected, or none to keep the selection.
    ///
    /// # Errors
    /// [`EditError`]: why the change is refused; the scene is then half-changed and must be discarded.
    pub fn apply(self, scene: &mut Scene) -> Result<Vec<Item>, EditError> {
        match self {
            Self::Camera(camera, _) => scene.camera = camera,
            Self::Background(color) => scene.background = color,
            Self::Ambient(intensity) => scene.ambient_intensity = intensity,
            Self::LightVisualization(visible) => scene.light_visualization = visible,
            Self::Render(render, _) => scene.render = render,
            Self::Animation(animation, _) => scene.animation = animation,
            Self::Object(index, object, _) => replace(&mut scene.objects, index, *object),
            Self::Light(index, light, _) => replace(&mut scene.lights, index, light),
            Self::Pack(index, pack, _) => {
                if let Some((_, slot)) = scene.packs_mut().get_index_mut(index) {
                    *slot = pack;
                }
            }
            Self::AddObject(name, shape) => return Ok(vec![add_object(scene, name, shape)]),
            Self::Import(parts) => return Ok(vec![Item::object(scene.add_parts(parts))]),
            Self::Join(joined) => {
                return Ok(scene.join(&joined).map(Item::object).into_iter().collect());
            }
            Self::Paste(pasted, _) => return Ok(paste(scene, &pasted)),
            Self::Separate(index) => {
                return Ok(scene.separate(index).map(Item::object).collect());
            }
            Self::AddLight(position) => return Ok(vec![add_light(scene, position)]),
            Self::AddPack => return Ok(vec![add_pack(scene)]),
            Self::Rename(item, name) => rename(scene, item, name.trim())?,
            Self::Duplicate(item) => return Ok(duplicate(scene, item).into_iter().collect()),
            Self::Delete(items) => delete(scene, items)?,
            Self::Move(items, to) => return Ok(move_items(scene, items, to)),
            Self::Arrange(arrangement) => return Ok(arrange(scene, arrangement)),
            Self::MakePacksUnique(objects) => make_packs_unique(scene, &objects),
            Self::MergePacks => scene.merge_equal_packs(),
            Self::RenameGroup(from, to) => rename_group(scene, &from, &to)?,
            Self::Group(members, name) => return Ok(group(scene, &members, &name)),
            Self::Bookmarks(bookmarks, _) => scene.bookmarks = bookmarks,
            Self::Each(edits, _) => {
                for edit in edits {
                    edit.apply(scene)?;
                }
            }
        }
        Ok(Vec::new())
    }
}

fn replace<T: Clone>(list: &mut List<T>, index: usize, value: T) {
    if let Some(slot) = list.get_mut(index) {
        *slot = value;
    }
}

/// Deletes items; color packs last, as their users may be among the items.
fn delete(scene: &mut Scene, mut items: Vec<Item>) -> Result<(), EditError> {
    // In descending order, so that deleting one does not shift the indices of the rest.
    items.sort_unstable_by(|a, b| b.cmp(a));
    items.dedup();
    let (mut objects, mut lights) = (Vec::new(), Vec::new());
    for &Item { kind, index } in &items {
        match kind {
            ItemKind::Object if index < scene.objects.len() => {
                objects.push(scene.objects.remove(index).name);
            }
            ItemKind::Light if index < scene.lights.len() => {
                lights.push(scene.lights.remove(index).name);
            }
            _ => {}
        }
    }
    if !scene.animation.tracks.is_empty() {
        let gone = objects.iter().map(|name| Owner::Object(name));
        let gone = gone.chain(lights.iter().map(|name| Owner::Light(name)));
        scene.animation_mut().forget(&gone.collect());
    }
    let packs = items.iter().filter(|item| item.kind == ItemKind::Pack);
    let packs: BTreeSet<usize> = packs.map(|item| item.index).collect();
    if packs.is_empty() {
        return Ok(());
    }
    let used = scene.used_packs();
    let names = packs
        .iter()
        .map(|&index| scene.color_packs.get_index(index));
    if let Some((name, _)) = names.flatten().find(|(name, _)| used.contains(&***name)) {
        let users = Item::users_of_pack(scene, name);
        let users = users.filter_map(|user| user.name(scene)).map(str::to_owned);
        return Err(EditError::PackInUse {
            name: name.clone(),
            users: listed(users).unwrap_or_default(),
        });
    }
    let mut indices = 0..;
    let is_kept = |index: usize| !packs.contains(&index);
    let packs = scene.packs_mut();
    packs.retain(|_, _| indices.next().is_some_and(is_kept));
    Ok(())
}

/// Renames the light or object that tracks refer to. Without any, the animation stays shared with the scene before.
fn rename_owner(scene: &mut Scene, owner: Owner, to: &str) {
    let mut tracks = scene.animation.tracks.iter();
    if tracks.any(|track| track.target.owner() == Some(owner)) {
        scene.animation_mut().rename_owner(owner, to);
    }
}

fn rename(scene: &mut Scene, item: Item, to: &str) -> Result<(), EditError> {
    let Some(from) = item
        .name(scene)
        .map(str::to_owned)
        .filter(|from| from != to)
    else {
        return Ok(());
    };
    match item.kind {
        ItemKind::Object => {
            to.clone_into(&mut scene.objects[item.index].name);
            rename_owner(scene, Owner::Object(&from), to);
        }
        ItemKind::Light => {
            to.clone_into(&mut scene.lights[item.index].name);
            rename_owner(scene, Owner::Light(&from), to);
        }
        ItemKind::Pack if scene.color_packs.contains_key(to) => {
            return Err(EditError::PackNameTaken(to.to_owned()));
        }
        ItemKind::Pack => {
            let pack = scene.packs_mut().shift_remove(&from).unwrap_or_default();
            scene
                .packs_mut()
                .shift_insert(item.index, to.to_owned(), pack);
            scene.replace_packs(|name| (name == from).then_some(to));
        }
    }
    Ok(())
}

fn rename_group(scene: &mut Scene, from: &str, to: &str) -> Result<(), EditError> {
    if from == to {
        return Ok(());
    }
    if scene.objects.iter().any(|object| object.group == to) {
        return Err(EditError::GroupNameTaken(to.to_owned()));
    }
    for index in 0..scene.objects.len() {
        if scene.objects[index].group == from {
            to.clone_into(&mut scene.objects[index].group);
        }
    }
    Ok(())
}

/// Moves items of one kind to index `to`; returns their new items, in the given order.
fn move_items(scene: &mut Scene, items: Vec<Item>, to: usize) -> Vec<Item> {
    let Some(kind) = items.first().map(|item| item.kind) else {
        return items;
    };
    let count = kind.count(scene);
    let exists = |item: &&Item| item.kind == kind && item.index < count;
    let moved = items.iter().filter(exists).map(|item| item.index);
    let mut moved: Vec<usize> = moved.collect();
    moved.sort_unstable();
    moved.dedup();
    let to = to.min(count - moved.len());
    match kind {
        ItemKind::Object => move_within(&mut scene.objects, &moved, to),
        ItemKind::Light => move_within(&mut scene.lights, &moved, to),
        ItemKind::Pack => {
            let packs = scene.packs_mut();
            let taken = moved.iter().rev();
            let taken = taken.filter_map(|index| packs.shift_remove_index(*index));
            for (name, pack) in taken.collect::<Vec<_>>() {
                packs.shift_insert(to, name, pack);
            }
        }
    }
    let moved_item = |item: &Item| {
        let rank = moved.binary_search(&item.index).ok()?;
        Some(Item {
            kind,
            index: to + rank,
        })
    };
    items.iter().filter(exists).filter_map(moved_item).collect()
}

//! The map of which object is seen at each pixel, requested when nothing moves, and the outlines drawn from it.

use std::collections::{BTreeSet, HashSet};

use egui::{Color32, Context, Painter, Pos2, Rect, TextureHandle, TextureOptions, pos2, vec2};

use super::outline::{PixelObject, outline};
use crate::editor::{Editor, Item};
use crate::image::{ObjectMap, Thing};
use crate::plan::RenderRequest;
use crate::scene::Scene;
use crate::ui::theme::palette;
use crate::ui::upload::paint;
use crate::ui::viewport::Place;
use crate::worker::Question;

/// The objects seen in the last picture that was examined.
#[derive(Default)]
pub struct SeenObjects {
    map: Option<(u64, ObjectMap)>,
    /// Revision and size of the picture that was last asked about.
    requested: Option<(u64, (u32, u32))>,
    /// The outlines of the selection, and of what is hovered.
    outlines: [OutlineTextures; 2],
}

/// An outline as a texture.
#[derive(Default)]
struct OutlineTextures {
    /// Revision of the map, colour, and outlined items that the texture was made for.
    made_for: Option<(u64, Color32, Vec<Item>)>,
    /// The texture, and its rectangle in pixels of the map.
    shown: Option<(Rect, TextureHandle)>,
}

/// The item of a thing in the picture.
pub fn item_of(thing: Thing) -> Item {
    match thing {
        Thing::Light(index) => Item::light(index),
        Thing::Object(index) => Item::object(index),
    }
}

/// The thing, and after it the others of its group, which are selected with it.
pub fn with_group(scene: &Scene, thing: Thing) -> Vec<Thing> {
    let mut things = vec![thing];
    if let Thing::Object(index) = thing
        && let Some(group) = scene.objects.get(index).map(|object| &object.group)
        && !group.is_empty()
    {
        let objects = scene.objects.iter().enumerate();
        let others = objects.filter(|(other, object)| *other != index && object.group == *group);
        things.extend(others.map(|(other, _)| Thing::Object(other)));
    }
    things
}

impl SeenObjects {
    /// Returns the question which objects are seen in the picture at `place`, unless it was already asked.
    pub fn request_map(&mut self, editor: &Editor, place: Place) -> Option<Question> {
        let wanted = (editor.shown_revision(), place.pixels);
        if self.requested == Some(wanted) {
            return None;
        }
        self.requested = Some(wanted);
        Some(question(editor, place, Vec::new()))
    }

    /// Takes over an answer.
    pub fn take(&mut self, revision: u64, map: ObjectMap) {
        self.map = Some((revision, map));
        // The outlines are stored in pixels of the map, whose size may have changed.
        for outline in &mut self.outlines {
            outline.made_for = None;
        }
    }

    /// The map, if it belongs to the scene on screen.
    pub fn map(&self, editor: &Editor) -> Option<&ObjectMap> {
        let (revision, map) = self.map.as_ref()?;
        (*revision == editor.shown_revision()).then_some(map)
    }

    /// The thing seen at a position in the picture at `view`, if known.
    pub fn at(&self, editor: &Editor, view: Rect, at: Pos2) -> Option<Thing> {
        let map = self.map(editor)?;
        let [column, row] = pixel(map, view, at)?;
        map.at(column, row)
    }

    /// All items seen in a part of the picture at `view`, except infinite planes, which are behind everything.
    pub fn within(&self, editor: &Editor, view: Rect, part: Rect) -> Vec<Item> {
        let Some(map) = self.map(editor) else {
            return Vec::new();
        };
        let part = part.intersect(view);
        let corners = (pixel(map, view, part.min), pixel(map, view, part.max));
        let (Some(from), Some(to)) = corners else {
            return Vec::new();
        };
        let mut found = BTreeSet::new();
        let mut last = None;
        for row in from[1]..=to[1] {
            for thing in map.row(row).take(to[0] + 1).skip(from[0]) {
                if thing != last {
                    found.extend(thing);
                    last = thing;
                }
            }
        }
        found.retain(|thing| is_finite(editor.scene(), *thing));
        found.into_iter().map(item_of).collect()
    }

    /// Draws outlines around the selection and around what is hovered.
    pub fn show(&mut self, painter: &Painter, editor: &Editor, view: Rect, mut hovered: Vec<Item>) {
        let current = |(revision, _): &&(u64, _)| *revision == editor.shown_revision();
        let Some((revision, map)) = self.map.as_ref().filter(current) else {
            return;
        };
        let colors = palette(painter.ctx());
        // What is hovered is one item, or a group of which nothing is selected.
        if hovered
            .first()
            .is_some_and(|item| editor.selection().has(*item))
        {
            hovered.clear();
        }
        let selected = editor.selection().items().to_vec();
        let wanted = [(colors.accent, selected), (colors.text, hovered)];
        for (outline, (color, items)) in self.outlines.iter_mut().zip(wanted) {
            let wanted = (*revision, color, items);
            outline.update(painter.ctx(), (map, editor.shown()), wanted);
            outline.show(painter, map, view);
        }
    }
}

/// Returns whether a thing is finite.
pub fn is_finite(scene: &Scene, thing: Thing) -> bool {
    match thing {
        Thing::Object(index) => {
            let object = scene.objects.get(index);
            object.is_some_and(|object| object.shape.bounds().is_some())
        }
        Thing::Light(_) => true,
    }
}

/// The question which objects are seen in the picture at `place`, with the things in `without` left out.
pub fn question(editor: &Editor, place: Place, without: Vec<Thing>) -> Question {
    let (width, height) = place.pixels;
    let request = RenderRequest::of(editor.shown(), width, height);
    Question::Objects(editor.shown_revision(), Box::new(request), without)
}

/// The pixel of the map at a position in the picture at `view`.
pub fn pixel(map: &ObjectMap, view: Rect, at: Pos2) -> Option<[usize; 2]> {
    let share = (at - view.min) / view.size();
    let inside = |share: f32, count: usize| {
        let last = count.checked_sub(1)?;
        (0.0..=1.0)
            .contains(&share)
            .then(|| ((share * count as f32) as usize).min(last))
    };
    Some([
        inside(share.x, map.width())?,
        inside(share.y, map.height())?,
    ])
}

impl OutlineTextures {
    fn update(
        &mut self,
        ctx: &Context,
        (map, scene): (&ObjectMap, &Scene),
        wanted: (u64, Color32, Vec<Item>),
    ) {
        if self.made_for.as_ref() == Some(&wanted) {
            return;
        }
        let (_, color, items) = &wanted;
        let all: HashSet<Item> = items.iter().copied().collect();
        let made = (!items.is_empty()).then(|| {
            let colors = (*color, palette(ctx).halo);
            outline(map, colors, |thing| PixelObject {
                is_wanted: all.contains(&item_of(thing)),
                is_finite: is_finite(scene, thing),
            })
        });
        self.shown = made.flatten().map(|outline| {
            let [left, top] = outline.corner.map(|place| place as f32);
            let [width, height] = outline.image.size.map(|side| side as f32);
            let rect = Rect::from_min_size(pos2(left, top), vec2(width, height));
            let texture = ctx.load_texture("outline", outline.image, TextureOptions::NEAREST);
            (rect, texture)
        });
        self.made_for = Some(wanted);
    }

    fn show(&self, painter: &Painter, map: &ObjectMap, view: Rect) {
        let Some((part, texture)) = &self.shown else {
            return;
        };
        let scale = view.size() / vec2(map.width() as f32, map.height() as f32);
        let corner = view.min + part.min.to_vec2() * scale;
        let rect = Rect::from_min_size(corner, part.size() * scale);
        paint(painter, texture, rect);
    }
}

//! What is seen where: the map of the picture's objects, asked for when nothing moves, and the lines drawn
//! after it.

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

/// What is seen in the newest picture that was looked at.
#[derive(Default)]
pub struct SeenObjects {
    map: Option<(u64, ObjectMap)>,
    /// Revision and size of the picture that was asked about.
    asked: Option<(u64, (u32, u32))>,
    /// The lines of what is selected, and of what the pointer is over.
    lines: [OutlineTextures; 2],
}

/// Lines on the graphics card.
#[derive(Default)]
struct OutlineTextures {
    /// The revision of the map, the colour, and what is surrounded.
    made_for: Option<(u64, Color32, Vec<Item>)>,
    /// Where they are, in pixels of the picture.
    shown: Option<(Rect, TextureHandle)>,
}

/// The entry of the scene's lists that a thing is.
pub fn item_of(thing: Thing) -> Item {
    match thing {
        Thing::Light(index) => Item::light(index),
        Thing::Object(index) => Item::object(index),
    }
}

impl SeenObjects {
    /// The question what is seen in the picture at `place`, if that is neither known nor asked.
    pub fn wanted(&mut self, editor: &Editor, place: Place) -> Option<Question> {
        let wanted = (editor.shown_revision(), place.pixels);
        if self.asked == Some(wanted) {
            return None;
        }
        self.asked = Some(wanted);
        Some(question(editor, place, Vec::new()))
    }

    /// Takes up an answer.
    pub fn take(&mut self, revision: u64, map: ObjectMap) {
        self.map = Some((revision, map));
        // Of another size, it has the lines elsewhere.
        for lines in &mut self.lines {
            lines.made_for = None;
        }
    }

    /// The map, if it is that of the scene on show.
    pub fn map(&self, editor: &Editor) -> Option<&ObjectMap> {
        let (revision, map) = self.map.as_ref()?;
        (*revision == editor.shown_revision()).then_some(map)
    }

    /// What is seen at a place of the picture at `view`, as far as that is known.
    pub fn at(&self, editor: &Editor, view: Rect, at: Pos2) -> Option<Thing> {
        let map = self.map(editor)?;
        let [column, row] = pixel(map, view, at)?;
        map.at(column, row)
    }

    /// Everything that is seen in a part of the picture at `view`; endless planes are behind it.
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
        found.retain(|thing| ends(editor.scene(), *thing));
        found.into_iter().map(item_of).collect()
    }

    /// Draws lines around what is selected, and around what the pointer is over.
    pub fn show(&mut self, painter: &Painter, editor: &Editor, view: Rect, mut hovered: Vec<Item>) {
        let Some((revision, map)) = &self.map else {
            return;
        };
        if *revision != editor.shown_revision() {
            return;
        }
        let colors = palette(painter.ctx());
        let selected = editor.selection().items().to_vec();
        let own: HashSet<&Item> = selected.iter().collect();
        hovered.retain(|item| !own.contains(item));
        let wanted = [(colors.accent, selected), (colors.text, hovered)];
        for (lines, (color, items)) in self.lines.iter_mut().zip(wanted) {
            let wanted = (*revision, color, items);
            lines.update(painter.ctx(), (map, editor.shown()), wanted);
            lines.show(painter, map, view);
        }
    }
}

/// Whether a thing has an end.
pub fn ends(scene: &Scene, thing: Thing) -> bool {
    match thing {
        Thing::Object(index) => {
            let object = scene.objects.get(index);
            object.is_some_and(|object| object.shape.bounds().is_some())
        }
        Thing::Light(_) => true,
    }
}

/// The question what is seen in the picture at `place`, as if nothing of `without` were there.
pub fn question(editor: &Editor, place: Place, without: Vec<Thing>) -> Question {
    let (width, height) = place.pixels;
    let request = RenderRequest::of(editor.shown(), width, height);
    Question::Objects(editor.shown_revision(), Box::new(request), without)
}

/// The pixel at a place of the picture at `view`.
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
                ends: ends(scene, thing),
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

//! The maps of where formulas break, and where the open scene stands on them.

use std::sync::mpsc::{Receiver, TryRecvError};

use egui::{RichText, ScrollArea, Ui, vec2};

use super::super::raster::draw;
use super::super::theme::{GRID, palette};
use super::heat;
use crate::animate::motion_between;
use crate::image::Image;
use crate::lab::stability::{Map, maps};
use crate::scene::{Method as _, Orientation, Scene, Shape, Sphere};
use crate::worker::run_in_background;

/// How many times more tries than for a first look: a second of computing.
const EFFORT: u32 = 4;
/// Size of one map in a picture of all, in points.
const TILE: (f32, f32) = (300.0, 230.0);
/// Maps beside each other in a picture of all.
const COLUMNS: usize = 4;
/// Width of the list of methods.
const LIST: f32 = 330.0;

/// The tab's state.
#[derive(Default)]
pub struct Stability {
    maps: Vec<Map>,
    coming: Option<Receiver<Vec<Map>>>,
    chosen: usize,
}

impl Stability {
    /// Shows the tab; the maps are computed when it is first seen.
    pub fn show(&mut self, ui: &mut Ui, scene: &Scene) {
        if self.maps.is_empty() {
            return self.fetch(ui);
        }
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(LIST);
                let list = ScrollArea::vertical().auto_shrink(false);
                list.show(ui, |ui| self.show_list(ui, scene));
            });
            ui.vertical(|ui| {
                let map = &self.maps[self.chosen];
                let stand = standing(scene, map);
                ui.label(headline(map));
                let warning = stand.filter(|&stand| heat::is_near_failing(map, stand));
                match (warning, is_used(scene, map)) {
                    (Some(_), true) => {
                        let text = "Your scene uses this, within a decade of where it fails.";
                        ui.colored_label(palette(ui.ctx()).error, text);
                    }
                    (Some(_), false) => {
                        ui.weak("Here this would fail your scene, within a decade.");
                    }
                    _ => {
                        ui.weak("The frame is where your scene stands.");
                    }
                }
                let size = ui.available_size() - vec2(GRID, GRID);
                heat::show(ui, map, size.min(vec2(720.0, 600.0)), stand);
            });
        });
    }

    fn fetch(&mut self, ui: &mut Ui) {
        let coming = self
            .coming
            .get_or_insert_with(|| run_in_background("glint-stability", || maps(EFFORT)));
        match coming.try_recv() {
            Ok(maps) => self.maps = maps,
            Err(TryRecvError::Disconnected) => self.coming = None,
            Err(TryRecvError::Empty) => {}
        }
        ui.centered_and_justified(|ui| ui.weak("Trying every formula…"));
        ui.request_repaint_after(std::time::Duration::from_millis(100));
    }

    fn show_list(&mut self, ui: &mut Ui, scene: &Scene) {
        for (place, map) in self.maps.iter().enumerate() {
            let used = if is_used(scene, map) { "●" } else { " " };
            let text = format!(
                "{used} {:<19}{:<22}{:>8.3}%",
                map.subject,
                map.method,
                map.total().rate() * 100.0
            );
            let row = ui.selectable_label(place == self.chosen, RichText::new(text).monospace());
            if row.on_hover_text(headline(map)).clicked() {
                self.chosen = place;
            }
        }
    }
}

/// A picture of all maps.
pub fn stability_picture(maps: &[Map]) -> Image {
    let rows = maps.len().div_ceil(COLUMNS);
    let (width, height) = TILE;
    let size = (COLUMNS as f32 * width, rows as f32 * height);
    draw(size.0 as u32, size.1 as u32, 2.0, |ui| {
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        for row in maps.chunks(COLUMNS) {
            ui.horizontal(|ui| {
                for map in row {
                    ui.allocate_ui(vec2(width, height), |ui| {
                        ui.vertical(|ui| {
                            ui.set_width(width);
                            ui.set_min_height(height);
                            ui.add_space(GRID);
                            let star = if map.is_default { " *" } else { "" };
                            ui.label(format!("   {} {}{star}", map.subject, map.method));
                            let room = vec2(width - 2.0 * GRID, height - 5.0 * GRID);
                            heat::show(ui, map, room, None);
                        });
                    });
                }
            });
        }
    })
}

fn headline(map: &Map) -> String {
    let default = if map.is_default { " (the default)" } else { "" };
    format!("{} {}{default}: {}", map.subject, map.method, map.failure)
}

/// Whether the scene asks for this method.
fn is_used(scene: &Scene, map: &Map) -> bool {
    let render = &scene.render;
    let word = match map.subject {
        "sphere" => render.sphere.id(),
        "triangle" => render.triangle.id(),
        "highlight" => render.specular.id(),
        "shadow acne" | "shadow leak" | "mesh acne" | "mesh leak" => render.offset.id(),
        // There is one way of doing the rest.
        _ => return map.is_default,
    };
    word == map.method
}

/// Where the scene stands on a map, as far as that can be said.
fn standing(scene: &Scene, map: &Map) -> Option<(f64, f64)> {
    let (low, high) = scene.bounds()?;
    let size = (high - low).length() / 2.0;
    let away = ((low + high) * 0.5).length() / size;
    match map.subject {
        "sphere" => {
            let eye = scene.camera.position;
            let spheres = scene
                .objects
                .iter()
                .filter_map(|object| match object.shape {
                    Shape::Sphere(Sphere { center, radius }) => {
                        Some(((center - eye).length() / radius, radius))
                    }
                    _ => None,
                });
            spheres.max_by(|a, b| a.0.total_cmp(&b.0))
        }
        "disc" => {
            let eye = scene.camera.position;
            let discs = scene
                .objects
                .iter()
                .filter_map(|object| match &object.shape {
                    Shape::Disc(disc) => {
                        Some(((disc.center - eye).length() / disc.radius, disc.radius))
                    }
                    _ => None,
                });
            discs.max_by(|a, b| a.0.total_cmp(&b.0))
        }
        "highlight" => {
            let packs = scene.color_packs.values().map(|pack| pack.phong_exponent);
            packs.max_by(f64::total_cmp).map(|sharpest| (sharpest, 1.0))
        }
        "plane" | "camera after turns" => None,
        "camera at the pole" => {
            let pitch = Orientation::of(&scene.camera).pitch.to_degrees();
            Some((90.0 - pitch.abs(), 1.0))
        }
        "turn between keys" => {
            let keys = scene.animation.keys.windows(2);
            let turns = keys.map(|pair| motion_between(&pair[0].value, &pair[1].value).turn);
            turns.max_by(f64::total_cmp).map(|turn| (turn, 1.0))
        }
        "path between keys" => {
            let keys = scene.animation.keys.windows(2);
            let ways = keys.map(|pair| (pair[1].value.position - pair[0].value.position).length());
            let ways: Vec<f64> = ways.filter(|way| *way > 0.0).collect();
            let ratio = |pair: &[f64]| (pair[0] / pair[1]).max(pair[1] / pair[0]);
            let ratios = ways.windows(2).map(ratio);
            ratios.max_by(f64::total_cmp).map(|ratio| (ratio, 1.0))
        }
        // The plan moves every scene to the origin before it is traced.
        "triangle" => Some((0.0, size)),
        _ => Some((away, size)),
    }
}

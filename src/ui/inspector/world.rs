//! The properties of the world and of the still picture.

use egui::Ui;

use glam::DVec3;

use super::quality::Quality;
use super::title::title;
use crate::editor::{Edit, Editor};
use crate::scene::{
    MAX_REFLECTIONS, MAX_SIDE, Method, Render, Scene, Setting, VisitSetting,
    default_ambient_intensity,
};
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::rows::{Field, FieldRows, color_names, fraction};

/// Shows the properties of the scene as a whole.
pub fn show(ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
    title(ui, icons::WORLD, "World");
    let mut ambient = scene.ambient_intensity;
    let mut background = scene.background;
    let mut markers = scene.light_visualization;
    let mut rows = FieldRows::new(ui);
    rows.number(
        &fraction(
            "ambient",
            "Ambient intensity: how much of every ambient colour is seen without light, 0–1",
            default_ambient_intensity(),
        ),
        &mut ambient,
    );
    rows.color(
        color_names!("background"),
        "Colour of a ray that hits nothing, 0–255",
        DVec3::new(0.0, 0.0, 0.0),
        &mut background,
    );
    rows.toggle(
        "light markers",
        "Light visualization: whether light markers are shown (I on, U off)",
        &mut markers,
    );
    if ambient != scene.ambient_intensity {
        out.edit(Edit::Ambient(ambient));
    }
    if background != scene.background {
        out.edit(Edit::Background(background));
    }
    if markers != scene.light_visualization {
        out.edit(Edit::LightVisualization(markers));
    }
}

/// Shows the size of the still picture, and how it is traced.
pub fn show_picture(ui: &mut Ui, editor: &Editor, quality: &mut Quality, out: &mut UiRequests) {
    let scene = editor.shown();
    title(ui, icons::IMAGE, "Picture");
    let mut render = scene.render.clone();
    let defaults = Render::default();
    let mut rows = FieldRows::new(ui);
    for (name, hint, default, value) in [
        (
            "width",
            "Width of the high-res picture in pixels",
            defaults.width,
            &mut render.width,
        ),
        (
            "height",
            "Height of the high-res picture in pixels",
            defaults.height,
            &mut render.height,
        ),
    ] {
        let field = Field {
            name,
            hint,
            unit: " px",
            default: f64::from(default),
            range: 1.0..=f64::from(MAX_SIDE),
            speed: Some(2.0),
        };
        integer_row(&mut rows, &field, value);
    }
    let reflections = Field {
        name: "reflections",
        hint: "How many times light may be reflected on its way to the eye",
        unit: "",
        default: f64::from(defaults.reflection_limit),
        range: 0.0..=f64::from(MAX_REFLECTIONS),
        speed: Some(0.05),
    };
    integer_row(&mut rows, &reflections, &mut render.reflection_limit);
    rows.heading("Traced with");
    quality.show(&mut rows, editor, out);
    render.visit_settings(&mut MethodRows(&mut rows));
    let changed = rows.changed();
    if let Some(field) = changed.filter(|_| render != scene.render) {
        out.edit(Edit::Render(render, field));
    }
}

/// Adds one row for each setting that is a choice between methods.
struct MethodRows<'a, 'u>(&'a mut FieldRows<'u>);

impl VisitSetting for MethodRows<'_, '_> {
    fn visit<M: Method>(&mut self, setting: Setting, value: &mut M) {
        let methods = M::ALL
            .iter()
            .map(|method| (method.value, method.id.to_owned()));
        let mut options: Vec<(M, String)> = methods.collect();
        if options.iter().all(|(option, _)| option != value) {
            options.push((*value, value.id()));
        }
        let lines = M::ALL.iter();
        let lines =
            lines.map(|method| format!("\n{}: {} ({})", method.id, method.what, method.source));
        let hint = format!("{}{}", setting.what, lines.collect::<String>());
        self.0.choice(setting.label, &hint, value, options);
    }
}

/// A row for an integer.
fn integer_row(rows: &mut FieldRows, field: &Field, value: &mut u32) {
    let mut real = f64::from(*value);
    rows.number(field, &mut real);
    *value = real.round() as u32;
}

//! The list of what the tracer computes for the scene, and why.

use std::sync::Arc;

use egui::{CollapsingHeader, Id, RichText, Ui};

use crate::editor::Editor;
use crate::lab::Choice;
use crate::plan::{Need, RenderRequest, needs};
use crate::ui::hint::Hinted as _;
use crate::ui::theme::GRID;

/// Shows the needs of the scene; they are determined when the section is opened, and again on every edit while it
/// is open.
pub fn show(ui: &mut Ui, editor: &Editor, choice: Option<&Choice>) {
    let header = CollapsingHeader::new("What the scene needs").id_salt("needs");
    let response = header.show(ui, |ui| {
        for need in lines(ui, editor).iter() {
            ui.add_space(GRID / 2.0);
            ui.label(&need.what).hint(format!("Saves: {}", need.saves));
            ui.label(
                RichText::new(format!("because {}", need.why))
                    .small()
                    .weak(),
            );
        }
        if let Some(choice) = choice {
            ui.add_space(GRID / 2.0);
            ui.label("a sampling chosen by measuring");
            ui.label(RichText::new(choice.words()).small().weak());
        }
    });
    response
        .header_response
        .hint("What the tracer computes for this scene, what it leaves out, and why");
}

fn lines(ui: &Ui, editor: &Editor) -> Arc<Vec<Need>> {
    let id = Id::unique("needs of the scene");
    let (document, revision) = (editor.documents(), editor.shown_revision());
    let cached = ui.data(|data| data.get_temp::<(u64, u64, Arc<Vec<Need>>)>(id));
    let cached = cached.filter(|(of, ..)| *of == document);
    match cached {
        // Determining them plans the scene from scratch: not in every frame of a drag or a flight.
        Some((_, of, lines)) if of == revision || editor.is_moving() => lines,
        _ => {
            let scene = editor.shown();
            let lines = Arc::new(needs(scene, &RenderRequest::still(scene)));
            let cached = (document, revision, Arc::clone(&lines));
            ui.data_mut(|data| data.insert_temp(id, cached));
            lines
        }
    }
}

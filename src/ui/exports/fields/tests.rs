use super::*;
use crate::editor::{Action, Edit};
use crate::scene::Render;

#[test]
fn what_was_the_scenes_own_follows_it_and_what_was_chosen_stays() {
    let mut editor = Editor::demo();
    let own = Settings::of(&editor);
    let chosen = Settings {
        antialias: Sampling::Grid(3),
        ..own.clone()
    };
    let render = Render {
        antialias: Sampling::Grid(5),
        width: 640,
        ..editor.scene().render.clone()
    };
    editor.apply(Action::Edit(Edit::Render(render, "quality")));
    let fresh = Settings::of(&editor);
    let followed = own.for_scene(fresh.clone());
    assert_eq!(followed.antialias, Sampling::Grid(5));
    assert_eq!(followed.width, 640);
    let kept = chosen.for_scene(fresh);
    assert_eq!(kept.antialias, Sampling::Grid(3));
    assert_eq!(kept.width, 640);
}

//! The symbols of the window, from the embedded icon font.

use egui::{Response, RichText, Ui};
use egui_material_icons::MaterialIcon;
pub use egui_material_icons::icons::{
    ICON_ADD as ADD, ICON_ALBUM as DISC, ICON_ARROW_RIGHT_ALT as ONCE,
    ICON_CHANGE_HISTORY as TRIANGLE, ICON_CHECK as CHECK, ICON_CHEVRON_LEFT as BACK,
    ICON_CHEVRON_RIGHT as FORWARD, ICON_CIRCLE as SPHERE, ICON_CLOSE as CLOSE,
    ICON_CONTENT_COPY as COPY, ICON_CROP_LANDSCAPE as PLANE, ICON_DEPLOYED_CODE as MESH,
    ICON_DIAMOND as KEY, ICON_ERROR as ERROR, ICON_EXPAND_MORE as MORE,
    ICON_FIBER_MANUAL_RECORD as RECORD, ICON_FIRST_PAGE as FIRST, ICON_FOLDER as GROUP,
    ICON_IMAGE as IMAGE, ICON_INFO as INFO, ICON_LAST_PAGE as LAST, ICON_LIGHTBULB as LIGHT,
    ICON_LINK as LINK, ICON_MORE_HORIZ as OTHER, ICON_PALETTE as PACK, ICON_PAUSE as PAUSE,
    ICON_PLAY_ARROW as PLAY, ICON_PUBLIC as WORLD, ICON_REPEAT as LOOP,
    ICON_SELECT_ALL as SELECTED, ICON_SKIP_NEXT as NEXT, ICON_SKIP_PREVIOUS as PREVIOUS,
    ICON_STOP as STOP, ICON_SWAP_HORIZ as PING_PONG, ICON_VIDEOCAM as CAMERA,
    ICON_VISIBILITY as VISIBLE, ICON_VISIBILITY_OFF as HIDDEN,
};

use super::hint::Hinted as _;
use super::theme::{GRID, ICON};
use crate::editor::{Item, ItemKind};
use crate::scene::{Scene, Shape};

/// The symbol of a shape.
pub fn of_shape(shape: &Shape) -> MaterialIcon {
    match shape {
        Shape::Sphere(_) => SPHERE,
        Shape::Plane(_) => PLANE,
        Shape::Triangle(_) => TRIANGLE,
        Shape::Disc(_) => DISC,
        Shape::Mesh(_) => MESH,
    }
}

/// A symbol as text.
pub fn text(icon: MaterialIcon) -> RichText {
    icon.rich_text().size(ICON)
}

/// A button that is only a symbol. `name` is its accessible name and its tooltip.
pub fn button(ui: &mut Ui, icon: MaterialIcon, name: &str) -> Response {
    ui.scope(|ui| {
        ui.spacing_mut().button_padding.x = GRID / 2.0;
        let button = egui::Button::new(text(icon)).frame_when_inactive(false);
        ui.add(button).accessible_name(name).hint(name)
    })
    .inner
}

/// The symbol of an item.
pub fn of_item(scene: &Scene, item: Item) -> MaterialIcon {
    match item.kind {
        ItemKind::Light => LIGHT,
        ItemKind::Object => {
            let object = scene.objects.get(item.index);
            object.map_or(SPHERE, |object| of_shape(&object.shape))
        }
        ItemKind::Pack => PACK,
    }
}

//! `glint --install-desktop`: integration into the desktop and shells of one user.

use std::env;
use std::path::{Path, PathBuf};

use clap::Command;
use clap_complete::{Shell, generate};

use super::error::{CliError, say};
use crate::files::{make_folder, write_atomic};

/// The icon, 256 pixels wide, traced by Glint from `assets/icon.ron`.
const ICON: &[u8] = include_bytes!("../../assets/icon.png");

/// Where each shell looks for completions.
const SHELLS: [(Shell, &str); 3] = [
    (Shell::Bash, "bash-completion/completions/glint"),
    (Shell::Zsh, "zsh/site-functions/_glint"),
    (Shell::Fish, "fish/vendor_completions.d/glint.fish"),
];

/// Writes the menu entry, the icon, the manual pages and the shell completions into the user's data folder, and
/// prints their paths. Existing ones are replaced.
///
/// # Errors
/// [`CliError::Failed`], if there is no such folder or a file cannot be written.
pub fn install(mut command: Command) -> Result<(), CliError> {
    let folder = data_folder().ok_or_else(|| {
        CliError::failed("neither XDG_DATA_HOME nor HOME names the folder for user data")
    })?;
    let program = env::current_exe().map_err(CliError::failed)?;
    let entry = desktop_entry(&program);
    write(&folder, "applications/glint.desktop", entry.as_bytes())?;
    write(&folder, "icons/hicolor/256x256/apps/glint.png", ICON)?;
    let manual = folder.join("man/man1");
    let failed = |error| CliError::failed(format!("{}: {error}", manual.display()));
    make_folder(&manual).map_err(failed)?;
    clap_mangen::generate_to(command.clone(), &manual).map_err(failed)?;
    let commands = command
        .get_subcommands()
        .filter(|subcommand| !subcommand.is_hide_set());
    let names = commands.map(|subcommand| format!("glint-{}.1", subcommand.get_name()));
    for page in ["glint.1".to_owned()].into_iter().chain(names) {
        say(&manual.join(page).display().to_string());
    }
    for (shell, file) in SHELLS {
        let mut text = Vec::new();
        generate(shell, &mut command, "glint", &mut text);
        write(&folder, file, &text)?;
    }
    Ok(())
}

/// The user's data folder, according to the XDG Base Directory Specification.
fn data_folder() -> Option<PathBuf> {
    let folder = |name| {
        let folder = env::var_os(name).map(PathBuf::from);
        folder.filter(|folder| folder.is_absolute())
    };
    folder("XDG_DATA_HOME").or_else(|| Some(folder("HOME")?.join(".local/share")))
}

/// A menu entry according to the Desktop Entry Specification.
fn desktop_entry(program: &Path) -> String {
    // In a quoted argument these are escaped by a backslash, which is itself escaped in a string value.
    let mut quoted = String::new();
    for letter in program.display().to_string().chars() {
        match letter {
            '\\' => quoted.push_str(r"\\\\"),
            '"' | '`' | '$' => quoted.extend(['\\', '\\', letter]),
            '%' => quoted.push_str("%%"),
            _ => quoted.push(letter),
        }
    }
    format!(
        "[Desktop Entry]\nType=Application\nName=Glint\nComment={}\nExec=\"{quoted}\" %f\nIcon=glint\nCategories=Graphics;3DGraphics;\nStartupWMClass=glint\n",
        env!("CARGO_PKG_DESCRIPTION")
    )
}

fn write(folder: &Path, file: &str, bytes: &[u8]) -> Result<(), CliError> {
    let path = folder.join(file);
    let failed = |error| CliError::failed(format!("{}: {error}", path.display()));
    make_folder(path.parent().unwrap_or(folder)).map_err(failed)?;
    write_atomic(&path, bytes).map_err(failed)?;
    say(&path.display().to_string());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_names_the_program_wherever_it_is() {
        let entry = desktop_entry(Path::new("/opt/my $tools/100%/glint"));
        assert!(
            entry.contains("Exec=\"/opt/my \\\\$tools/100%%/glint\" %f\n"),
            "{entry}"
        );
    }
}

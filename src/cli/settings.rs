//! Flags for the tracer's settings, generated from the list in `scene`.

use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches, ValueHint};

use crate::scene::{Method, Render, Setting, VisitSetting};

/// The values that were given, by setting; all of them are valid.
#[derive(Clone, Debug, Default)]
pub struct SettingArgs {
    given: Vec<(&'static str, String)>,
}

impl SettingArgs {
    /// Replaces the scene's own values by those that were given.
    pub fn apply(&self, render: &mut Render) {
        for (name, id) in &self.given {
            render.choose(name, id);
        }
    }
}

/// Adds a flag for each setting to a command.
struct Flags(Command);

impl VisitSetting for Flags {
    fn visit<M: Method>(&mut self, setting: Setting, _value: &mut M) {
        let default_note = "[default: the scene's own]";
        let help = format!("{}: {} {default_note}", setting.what, M::syntax());
        let lines = M::ALL.iter();
        let lines = lines.map(|method| format!("\n- {}: {}", method.id, method.what));
        let arg = Arg::new(setting.name)
            .long(setting.name)
            .value_name("METHOD")
            .long_help(format!("{help}{}", lines.collect::<String>()))
            .help(help)
            // So that shells do not complete file names here.
            .value_hint(ValueHint::Other)
            .value_parser(|id: &str| M::parse(id).map(|_| id.to_owned()));
        self.0 = std::mem::take(&mut self.0).arg(arg);
    }
}

/// Reads the flags.
struct FlagReader<'a> {
    matches: &'a mut ArgMatches,
    given: Vec<(&'static str, String)>,
}

impl VisitSetting for FlagReader<'_> {
    fn visit<M: Method>(&mut self, setting: Setting, _value: &mut M) {
        let given = self.matches.remove_one(setting.name);
        self.given.extend(given.map(|id| (setting.name, id)));
    }
}

impl FromArgMatches for SettingArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, Error> {
        let mut read = FlagReader {
            matches,
            given: Vec::new(),
        };
        Render::default().visit_settings(&mut read);
        Ok(Self { given: read.given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for SettingArgs {
    fn augment_args(command: Command) -> Command {
        let mut flags = Flags(command);
        Render::default().visit_settings(&mut flags);
        flags.0
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

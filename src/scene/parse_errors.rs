//! Readable messages for errors of the RON parser.

use ron::Error;

/// Returns a hint for a number that follows `before`: a comma after digits may be meant as a decimal point.
fn decimals_hint(before: &str) -> &'static str {
    let number = before.trim_end().strip_suffix(',');
    if number.is_some_and(|number| number.ends_with(|c: char| c.is_ascii_digit())) {
        ": decimals are written after a point"
    } else {
        ""
    }
}

/// Returns the message for a parser error, without a full stop, given the text before and after its position.
/// `max_depth` is the nesting limit of the parser.
pub fn sentence(error: &Error, (before, after): (&str, &str), max_depth: usize) -> String {
    match error {
        // Usually a fourth number in a colour or a vector of three.
        Error::ExpectedStructLikeEnd
            if before.trim_end().ends_with(',') && after.starts_with(is_of_number) =>
        {
            "expected the closing bracket: there is one number too many".to_owned()
        }
        Error::SuggestRawIdentifier(name) if name.starts_with(is_of_number) => {
            let hint = decimals_hint(before);
            format!("expected the name of a field, found {name}{hint}")
        }
        // The parser has read the digits before the decimal point as an integer.
        Error::ExpectedComma | Error::ExpectedStructLikeEnd
            if before.ends_with(|c: char| c.is_ascii_digit()) && after.starts_with('.') =>
        {
            "expected a whole number".to_owned()
        }
        Error::ExpectedIdentifier if after.starts_with('"') => {
            "expected a name without quotation marks".to_owned()
        }
        Error::Message(message) => message.clone(),
        Error::Eof => "the file ends in the middle of the scene".to_owned(),
        Error::ExceededRecursionLimit => format!("brackets are nested more than {max_depth} deep"),
        Error::NoSuchStructField {
            expected,
            found,
            outer,
        } => {
            let owner = outer.as_deref().unwrap_or("this");
            format!("{owner} has no field `{found}`; it has {}", list(expected))
        }
        Error::NoSuchEnumVariant {
            expected, found, ..
        } => {
            format!("there is no `{found}` here; expected {}", list(expected))
        }
        Error::MissingStructField { field, outer } => {
            let owner = outer.as_deref().unwrap_or("this");
            format!("{owner} needs a field `{field}`, which is missing")
        }
        Error::DuplicateStructField { field, .. } => format!("the field `{field}` appears twice"),
        Error::ExpectedDifferentLength { expected, found } => {
            let such = if expected.contains("Sample") {
                "time, position, yaw, pitch and roll such as (0, (1, 2, 3), 0, 0, 0)"
            } else {
                "three numbers such as (1, 2, 3)"
            };
            format!("expected {such}, found {found}")
        }
        Error::ExpectedNamedStructLike(name) => format!("expected {name}(…)"),
        Error::ExpectedDifferentStructName { expected, found } => {
            format!("expected {expected}(…), found {found}")
        }
        Error::ExpectedBoolean => "expected true or false".to_owned(),
        Error::ExpectedFloat => "expected a number".to_owned(),
        Error::ExpectedInteger | Error::InvalidIntegerDigit { base: 10, .. } => {
            "expected a whole number".to_owned()
        }
        Error::ExpectedString => "expected text in quotation marks".to_owned(),
        Error::ExpectedStringEnd => "the text has no closing quotation mark".to_owned(),
        Error::ExpectedArray => "expected a list: […]".to_owned(),
        Error::ExpectedMap => "expected a map: {\"name\": …}".to_owned(),
        Error::ExpectedComma => "expected a comma".to_owned(),
        Error::ExpectedMapColon => "expected a colon".to_owned(),
        Error::ExpectedArrayEnd
        | Error::ExpectedStructLikeEnd
        | Error::ExpectedMapEnd
        | Error::ExpectedOptionEnd => "expected a comma or the closing bracket".to_owned(),
        Error::ExpectedStructLike => "expected an opening bracket: (…)".to_owned(),
        Error::ExpectedOption => "expected Some(…) or None".to_owned(),
        Error::ExpectedIdentifier => "expected a name".to_owned(),
        Error::ExpectedUnit => "expected ()".to_owned(),
        Error::ExpectedChar | Error::ExpectedByteLiteral | Error::ExpectedByteString => {
            "expected a number or text in quotation marks".to_owned()
        }
        Error::FloatUnderscore | Error::UnderscoreAtBeginning => {
            "the number has an underscore in the wrong place".to_owned()
        }
        Error::SuggestRawIdentifier(name) => {
            format!("there is no `{name}`: names consist of letters, digits and _")
        }
        Error::InvalidIntegerDigit { digit, base } => {
            format!("{digit:?} is not a digit in base {base}")
        }
        Error::UnexpectedChar(found) => format!("{found:?} is not allowed here"),
        Error::InvalidEscape(_) => {
            "the backslash in the text begins an unknown escape sequence".to_owned()
        }
        Error::NoSuchExtension(name) => format!("there is no RON extension named `{name}`"),
        Error::ExpectedAttribute | Error::ExpectedAttributeEnd => {
            "expected an attribute such as #![enable(…)]".to_owned()
        }
        Error::Utf8Error(_) => "the file is not UTF-8 text".to_owned(),
        Error::UnclosedLineComment => "the comment is not closed".to_owned(),
        Error::IntegerOutOfBounds => {
            "the number is out of range: it is too large, or less than 0".to_owned()
        }
        Error::InvalidValueForType { expected, found } => invalid_value(expected, found),
        Error::UnclosedBlockComment => "the comment has no closing */".to_owned(),
        Error::TrailingCharacters => "there is text after the end of the scene".to_owned(),
        other => other.to_string(),
    }
}

/// Returns the message for a value of the wrong type.
fn invalid_value(expected: &str, found: &str) -> String {
    let is_number = expected.contains("floating point");
    let expected = if is_number { "a number" } else { expected };
    format!("expected {expected}, found {found}")
}

/// Returns whether a number can start with this character.
fn is_of_number(letter: char) -> bool {
    letter.is_ascii_digit() || letter == '-'
}

fn list(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>()
        .join(", ")
}

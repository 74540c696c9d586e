//! Arithmetic expressions that are typed instead of a number.

/// Longest expression that is read, in bytes.
const MAX_LENGTH: usize = 100;

/// Evaluates an expression such as `2 * (1.5 + 3) / -4`, whose numbers `read` parses; `None` if it is invalid.
pub fn calculate(text: &str, read: fn(&str) -> Option<f64>) -> Option<f64> {
    if text.len() > MAX_LENGTH {
        return None;
    }
    let mut parser = Parser {
        remaining: text,
        read,
    };
    let value = parser.terms()?;
    let is_all = parser.remaining.trim().is_empty();
    Some(value).filter(|value| is_all && value.is_finite())
}

/// The rest of the expression still to be read.
struct Parser<'t> {
    remaining: &'t str,
    read: fn(&str) -> Option<f64>,
}

impl Parser<'_> {
    /// Returns whether this sign comes next, and skips it if so.
    fn accept(&mut self, sign: char) -> bool {
        let after = self.remaining.trim_start().strip_prefix(sign);
        self.remaining = after.unwrap_or(self.remaining);
        after.is_some()
    }

    fn terms(&mut self) -> Option<f64> {
        let mut value = self.factors()?;
        loop {
            if self.accept('+') {
                value += self.factors()?;
            } else if self.accept('-') {
                value -= self.factors()?;
            } else {
                return Some(value);
            }
        }
    }

    fn factors(&mut self) -> Option<f64> {
        let mut value = self.factor()?;
        loop {
            if self.accept('*') {
                value *= self.factor()?;
            } else if self.accept('/') {
                value /= self.factor()?;
            } else {
                return Some(value);
            }
        }
    }

    fn factor(&mut self) -> Option<f64> {
        if self.accept('-') {
            return self.factor().map(|value| -value);
        }
        if self.accept('(') {
            let value = self.terms()?;
            return self.accept(')').then_some(value);
        }
        let text = self.remaining.trim_start();
        let mut previous = ' ';
        let ends_number = |letter: char| {
            let is_sign = matches!(letter, '+' | '-') && matches!(previous, 'e' | 'E');
            let is_exponent = matches!(letter, 'e' | 'E') && previous.is_ascii_digit();
            previous = letter;
            !(letter.is_ascii_digit() || matches!(letter, '.' | ',') || is_exponent || is_sign)
        };
        let (number, remaining) = text.split_at(text.find(ends_number).unwrap_or(text.len()));
        self.remaining = remaining;
        (self.read)(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_what_school_says() {
        let read = |text: &str| text.parse().ok();
        for (text, value) in [
            ("5*4", 20.0),
            ("1 + 2 * 3", 7.0),
            ("(1+2)*3 - -1", 10.0),
            ("2*(1.5 + 3)/-4", -2.25),
            ("8/2/2", 2.0),
            ("1e2-1e-2", 99.99),
            ("-(2)", -2.0),
        ] {
            assert_eq!(calculate(text, read), Some(value), "{text}");
        }
        for text in ["", "5*", "(1", "1)", "1 2", "2**3", "1/0", "5x", "e1", "--"] {
            assert_eq!(calculate(text, read), None, "{text}");
        }
        assert_eq!(calculate(&"(".repeat(1_000_000), read), None);
    }
}

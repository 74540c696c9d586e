//! Arithmetic expressions that are typed instead of a number.

/// Longest expression that is read, in bytes.
const LONGEST: usize = 100;

/// Evaluates an expression such as `2 * (1.5 + 3) / -4`, whose numbers `read` parses; `None` if it is invalid.
pub fn calculate(text: &str, read: fn(&str) -> Option<f64>) -> Option<f64> {
    if text.len() > LONGEST {
        return None;
    }
    let mut sum = Sum { rest: text, read };
    let value = sum.terms()?;
    let is_all = sum.rest.trim().is_empty();
    Some(value).filter(|value| is_all && value.is_finite())
}

/// The rest of the expression still to be read.
struct Sum<'t> {
    rest: &'t str,
    read: fn(&str) -> Option<f64>,
}

impl Sum<'_> {
    /// Returns whether this sign comes next, and skips it if so.
    fn takes(&mut self, sign: char) -> bool {
        let after = self.rest.trim_start().strip_prefix(sign);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn terms(&mut self) -> Option<f64> {
        let mut value = self.factors()?;
        loop {
            if self.takes('+') {
                value += self.factors()?;
            } else if self.takes('-') {
                value -= self.factors()?;
            } else {
                return Some(value);
            }
        }
    }

    fn factors(&mut self) -> Option<f64> {
        let mut value = self.factor()?;
        loop {
            if self.takes('*') {
                value *= self.factor()?;
            } else if self.takes('/') {
                value /= self.factor()?;
            } else {
                return Some(value);
            }
        }
    }

    fn factor(&mut self) -> Option<f64> {
        if self.takes('-') {
            return self.factor().map(|value| -value);
        }
        if self.takes('(') {
            let value = self.terms()?;
            return self.takes(')').then_some(value);
        }
        let text = self.rest.trim_start();
        let mut before = ' ';
        let is_other = |letter: char| {
            let is_sign = matches!(letter, '+' | '-') && matches!(before, 'e' | 'E');
            let is_exponent = matches!(letter, 'e' | 'E') && before.is_ascii_digit();
            before = letter;
            !(letter.is_ascii_digit() || matches!(letter, '.' | ',') || is_exponent || is_sign)
        };
        let (number, rest) = text.split_at(text.find(is_other).unwrap_or(text.len()));
        self.rest = rest;
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

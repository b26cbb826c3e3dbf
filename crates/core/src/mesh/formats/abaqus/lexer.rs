//! Lines of an input file: keywords with their parameters, continued where a line ends with a comma, and data.

use std::iter::{Enumerate, Peekable};

/// A keyword or a line of data.
pub(super) enum Statement<'a> {
    Keyword(Keyword),
    Data(&'a str),
}

/// A keyword, in capitals without the star, and its parameters, names in capitals; a flag has an empty value.
pub(super) struct Keyword {
    pub name: String,
    pub parameters: Vec<(String, String)>,
}

/// The statements of a text, each with its line counted from 1; comments and blank lines are passed over.
pub(super) struct Statements<'a> {
    lines: Peekable<Enumerate<std::str::Lines<'a>>>,
}

impl<'a> Statements<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        Self { lines: text.lines().enumerate().peekable() }
    }

    /// Parameters on the lines after a keyword that ends with a comma.
    fn continue_keyword(&mut self, keyword: &mut String) {
        while keyword.trim_end().ends_with(',') {
            let Some((_, line)) = self.lines.next_if(|(_, line)| continues(line)) else { return };
            if !is_comment(line) {
                keyword.push_str(line.trim());
            }
        }
    }
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with("**")
}

/// Whether a line can belong to the parameters of a keyword: data never holds an equals sign.
fn continues(line: &str) -> bool {
    let flag = line.trim().trim_end_matches(',').to_ascii_uppercase();
    let parameter = !line.trim_start().starts_with('*') && (line.contains('=') || FLAGS.contains(&flag.as_str()));
    parameter || is_comment(line)
}

/// Parameters without a value that sets know.
pub(super) const FLAGS: [&str; 3] = ["GENERATE", "INTERNAL", "UNSORTED"];

impl<'a> Iterator for Statements<'a> {
    type Item = (usize, Statement<'a>);

    fn next(&mut self) -> Option<Self::Item> {
        let skipped = |line: &str| is_comment(line) || line.trim().is_empty();
        let (place, line) = self.lines.by_ref().find(|(_, line)| !skipped(line))?;
        let statement = match line.trim_start().strip_prefix('*') {
            None => Statement::Data(line),
            Some(keyword) => {
                let mut keyword = keyword.to_string();
                self.continue_keyword(&mut keyword);
                Statement::Keyword(Keyword::of(&keyword))
            }
        };
        Some((place + 1, statement))
    }
}

impl Keyword {
    fn of(text: &str) -> Self {
        let mut parts = text.split(',');
        let name = parts.next().unwrap_or("").split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
        let parameter = |part: &str| {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            let name = name.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
            (name, value.trim().trim_matches('"').to_string())
        };
        Self { name, parameters: parts.map(parameter).filter(|(name, _)| !name.is_empty()).collect() }
    }

    /// The value of a parameter, if it is there and not empty.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|parameter| parameter.0 == name);
        found.map(|parameter| parameter.1.as_str()).filter(|value| !value.is_empty())
    }

    /// Whether a parameter is there, with or without a value.
    pub(super) fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|parameter| parameter.0 == name)
    }
}

/// The fields of a data line, trimmed; a comma at its end adds none.
pub(super) fn fields(data: &str) -> impl Iterator<Item = &str> {
    let data = data.trim().trim_matches('\u{feff}');
    data.strip_suffix(',').unwrap_or(data).split(',').map(str::trim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_go_on_over_lines_and_data_does_not() {
        let text =
            "** a comment\n*Elset , elset = \"My Set\",\n** between\n generate\n1, 2,\n\n* NODE\n*NSET,NSET=a,\n3,4";
        let found: Vec<(usize, String)> = Statements::of(text)
            .map(|(line, statement)| match statement {
                Statement::Keyword(keyword) => (line, format!("{} {:?}", keyword.name, keyword.parameters)),
                Statement::Data(data) => (line, fields(data).collect::<Vec<_>>().join("|")),
            })
            .collect();
        let expected = [
            (2, r#"ELSET [("ELSET", "My Set"), ("GENERATE", "")]"#),
            (5, "1|2"),
            (7, "NODE []"),
            (8, r#"NSET [("NSET", "a")]"#),
            (9, "3|4"),
        ];
        assert_eq!(found, expected.map(|(line, text)| (line, text.to_string())));
    }
}

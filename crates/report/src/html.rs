//! Text as HTML.

use std::fmt::Write;

/// A text that may stand between tags and in quoted attributes. Characters that steer a terminal or turn the direction of
/// writing are replaced, as on the screen.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in asperity_core::error::visible(text).chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c => out.push(c),
        }
    }
    out
}

/// JSON that may stand in a script element: no `<` can end it early.
pub fn script_json(value: &impl serde::Serialize) -> Result<String, asperity_core::Error> {
    let text = serde_json::to_string(value).map_err(|error| asperity_core::Error::Internal(error.to_string()))?;
    Ok(text.replace('<', "\\u003c"))
}

/// A definition list.
pub fn definitions(lines: &[(&str, String)]) -> String {
    let mut out = String::from("<dl>");
    for (name, value) in lines.iter().filter(|(_, value)| !value.is_empty()) {
        // Writing into a String cannot fail.
        let _ = write!(out, "<div><dt>{}</dt><dd>{}</dd></div>", escape(name), escape(value));
    }
    out + "</dl>"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_is_a_tag_comes_through() {
        assert_eq!(escape("</script><b a='\"&"), "&lt;/script&gt;&lt;b a=&#39;&quot;&amp;");
        assert_eq!(escape("\u{1b}[31m\u{202e}"), "?[31m\u{fffd}");
        assert_eq!(script_json(&"</script>").unwrap(), "\"\\u003c/script>\"");
    }
}

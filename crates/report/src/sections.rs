//! The text of the page: it is there without scripts, and is what prints and what is read aloud.

use crate::folder::Folder;
use crate::html::{definitions, escape};
use asperity_results::output::{FIGURES, RunStatus};
use std::fmt::Write;

/// What the page is called.
pub fn title(folder: &Folder) -> String {
    match folder.summary.title.as_str() {
        "" => folder.path.file_name().map_or_else(|| "A run".into(), |name| name.to_string_lossy().into_owned()),
        title => title.to_owned(),
    }
}

/// Everything between the body's tags.
pub fn all(folder: &Folder, live: bool) -> String {
    let sections: [(&str, &str, String); 5] = [
        ("body", "The body", VIEW.into()),
        ("curves", "Curves", CURVES.into()),
        ("trust", "How far to trust it", trust(folder)),
        ("course", "How it went", course(folder)),
        ("asked", "What was asked", asked(folder)),
    ];
    let mut out = String::from(
        "<a class=\"skip\" href=\"#main\">Skip to the content</a>\n<nav aria-label=\"Parts of the page\">",
    );
    for (id, heading, _) in &sections {
        // Writing into a String cannot fail.
        let _ = write!(out, "<a href=\"#{id}\">{heading}</a>");
    }
    out += "<span class=\"gap\"></span><label>Colours <select id=\"theme\"><option value=\"\">as the system</option>\
            <option value=\"light\">light</option><option value=\"dark\">dark</option></select></label></nav>\n<main id=\"main\">\n";
    out += &head(folder);
    if live {
        out += LIVE;
    }
    for (id, heading, content) in &sections {
        let _ = writeln!(
            out,
            "<section id=\"{id}\" aria-labelledby=\"{id}-heading\"><h2 id=\"{id}-heading\">{heading}</h2>\n{content}\n</section>"
        );
    }
    let version = escape(&folder.summary.version);
    let _ = writeln!(out, "</main>\n<footer>Written by Asperity {version}. Units are those of the deck.</footer>");
    out
}

/// How the run stands, in a word and a class of the style.
fn standing(folder: &Folder) -> (&'static str, &'static str) {
    match folder.summary.status {
        RunStatus::Running if folder.runs => ("running", "going"),
        RunStatus::Running => ("broken off without a word", "bad"),
        RunStatus::Converged => ("converged", "good"),
        RunStatus::Doubtful => ("doubtful", "doubt"),
        RunStatus::NotConverged => ("not converged", "bad"),
        RunStatus::Stopped => ("stopped on request", "doubt"),
        RunStatus::InputError => ("wrong input", "bad"),
        RunStatus::FileError => ("broken off at a file", "bad"),
        RunStatus::InternalError => ("ended by a fault of the program", "bad"),
    }
}

fn head(folder: &Folder) -> String {
    let summary = &folder.summary;
    let (word, class) = standing(folder);
    let cut = summary.attempts.saturating_sub(summary.increments);
    let mut out = format!(
        "<header><h1>{}</h1>\n<p class=\"standing\"><strong id=\"standing\" class=\"{class}\">{word}</strong> \
         <span id=\"counts\">{} increments, {cut} cut, {} iterations, {} unknowns, time {}</span></p>\n",
        escape(&title(folder)),
        summary.increments,
        summary.iterations,
        summary.unknowns,
        number(summary.time),
    );
    if let Some(reason) = &summary.reason {
        let _ = writeln!(out, "<p class=\"reason\" id=\"reason\">{}</p>", escape(reason));
    }
    out + &likely(folder) + "</header>\n"
}

/// What the run most likely suffers from.
fn likely(folder: &Folder) -> String {
    let list = |lines: &[String]| lines.iter().map(|line| format!("<li>{}</li>", escape(line))).collect::<String>();
    let found = folder.summary.diagnosis.iter().map(|finding| {
        format!(
            "<li><strong>{}</strong> <code>{}</code><ul class=\"evidence\" aria-label=\"seen\">{}</ul>\
             <p>What to try:</p><ul class=\"advice\">{}</ul></li>\n",
            escape(&finding.what),
            escape(&finding.cause),
            list(&finding.evidence),
            list(&finding.advice)
        )
    });
    let found: String = found.collect();
    if found.is_empty() {
        found
    } else {
        format!("<section id=\"diagnosis\"><h2>Likely causes</h2><ol>{found}</ol></section>\n")
    }
}

/// Certificate, balance of energy, notes.
fn trust(folder: &Folder) -> String {
    let summary = &folder.summary;
    let mut rows = String::new();
    for figure in FIGURES {
        let Some(worst) = summary.worst.get(figure.name) else { continue };
        let (class, verdict) = match worst.limit {
            None => ("", ""),
            Some(limit) if worst.value <= limit => ("good", "within"),
            Some(_) => ("bad", "beyond"),
        };
        let limit = worst.limit.map_or(String::new(), number);
        let about = figure.limit.map_or("", |limit| limit.about);
        let place = if worst.value == 0.0 { String::new() } else { worst.place().trim_start().to_owned() };
        let show = match worst.position {
            Some(_) if worst.value != 0.0 => {
                format!("<button type=\"button\" class=\"show\" data-figure=\"{}\">show</button>", figure.name)
            }
            _ => String::new(),
        };
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\" title=\"{}\">{}<br><code>{}</code></th><td class=\"n\">{}</td><td class=\"n\">{limit}</td>\
             <td class=\"{class}\">{verdict}</td><td>{}</td><td>{show}</td></tr>",
            escape(about),
            escape(figure.words.trim()),
            figure.name,
            number(worst.value),
            escape(&place),
        );
    }
    let mut out = String::new();
    if rows.is_empty() {
        out += "<p>No increment was accepted, so nothing was read.</p>";
    } else {
        let _ = writeln!(
            out,
            "<p>The worst of all accepted increments. A figure beyond its limit makes a run doubtful.</p><div class=\"wide\"><table>\
             <thead><tr><th scope=\"col\">figure</th><th scope=\"col\">value</th><th scope=\"col\">limit</th><th scope=\"col\"></th>\
             <th scope=\"col\">where and when</th><th scope=\"col\"></th></tr></thead><tbody>\n{rows}</tbody></table></div>"
        );
    }
    out += "<h3>Notes</h3>\n";
    if summary.notes.is_empty() {
        out += "<p>There are none.</p>\n";
    } else {
        let notes: String = summary.notes.iter().map(|note| format!("<li>{}</li>\n", escape(note))).collect();
        let _ = writeln!(out, "<ul class=\"notes\">{notes}</ul>");
    }
    out + "<h3>Balance of energy</h3>\n<div class=\"chart\" id=\"energy-chart\"></div>\n<h3>Audit and equilibrium, each increment</h3>\n\
           <div class=\"chart\" id=\"audit-chart\"></div>\n"
}

/// Counts, times, memory, increments, iterations.
fn course(folder: &Folder) -> String {
    let summary = &folder.summary;
    let mut lines = vec![
        ("attempts", summary.attempts.to_string()),
        ("accepted increments", summary.increments.to_string()),
        ("iterations", summary.iterations.to_string()),
        ("completed steps", summary.steps.to_string()),
        ("unknowns", summary.unknowns.to_string()),
        ("threads", summary.threads.to_string()),
        ("largest memory", summary.peak_memory.map_or(String::new(), |bytes| format!("{:.1} MB", bytes as f64 / 1e6))),
    ];
    let timings: Vec<(String, f64)> =
        summary.timings.iter().map(|(name, seconds)| (format!("seconds of {name}"), *seconds)).collect();
    lines.extend(timings.iter().map(|(name, seconds)| (name.as_str(), format!("{seconds:.3}"))));
    let files: String = summary.files.iter().map(|file| format!("<li>{}</li>", escape(file))).collect();
    format!(
        "{}\n<h3>Increments</h3>\n<div class=\"chart\" id=\"size-chart\"></div>\n<div class=\"controls\"><label><input type=\"checkbox\" id=\"only-cuts\"> only what was cut</label></div>\n\
         <div class=\"wide tall\" id=\"increments\" tabindex=\"0\" role=\"region\" aria-label=\"Table of attempts\"></div>\n\
         <h3>Iterations</h3>\n<div class=\"controls\"><label>Increment <select id=\"which\"></select></label></div>\n<div class=\"chart\" id=\"residual-chart\"></div>\n\
         <h3>Files</h3>\n<ul class=\"files\">{files}</ul>\n",
        definitions(&lines)
    )
}

/// Deck, defaults, fingerprint.
fn asked(folder: &Folder) -> String {
    let summary = &folder.summary;
    let hash = summary.input_hash.clone().unwrap_or_default();
    let lines = [
        ("deck", folder.asked.as_ref().map_or(String::new(), |asked| asked.path.clone())),
        ("fingerprint of deck and mesh", hash),
        ("program", format!("Asperity {}", summary.version)),
        ("space", summary.space.clone()),
        ("bodies", summary.bodies.join(", ")),
        ("materials", summary.materials.join(", ")),
        ("tools", summary.tools.join(", ")),
        ("contacts", summary.contact_order.join(", ")),
    ];
    let mut out = definitions(&lines);
    let Some(asked) = &folder.asked else {
        return out + "<p>These results were written by a version that did not keep the deck.</p>";
    };
    if !asked.sets.is_empty() {
        let sets: String = asked.sets.iter().map(|set| format!("<li><code>{}</code></li>", escape(set))).collect();
        let _ = writeln!(out, "<h3>Changed by --set</h3><ul>{sets}</ul>");
    }
    let _ = writeln!(
        out,
        "<h3>Deck</h3>\n<pre class=\"wide\" tabindex=\"0\" aria-label=\"Text of the deck\"><code>{}</code></pre>",
        escape(&asked.text)
    );
    let defaults: String = asked
        .defaults
        .iter()
        .map(|(key, value)| {
            format!("<tr><th scope=\"row\"><code>{}</code></th><td>{}</td></tr>\n", escape(key), escape(value))
        })
        .collect();
    if !defaults.is_empty() {
        let _ = writeln!(
            out,
            "<details><summary>{} keys that were not said, and what holds instead</summary><div class=\"wide\"><table><tbody>{defaults}</tbody></table></div></details>",
            asked.defaults.len()
        );
    }
    out
}

/// A number as people read it.
fn number(value: f64) -> String {
    match value {
        0.0 => "0".into(),
        value if (1e-3..1e6).contains(&value.abs()) => {
            let digits = (5 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
            let text = format!("{value:.digits$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
        value => format!("{value:.3e}"),
    }
}

const VIEW: &str = include_str!("../assets/view.html");
const CURVES: &str = include_str!("../assets/curves.html");
const LIVE: &str = include_str!("../assets/live.html");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 1.0, 0.2, 12345.678, 1e-9, 100_000.0, -0.05].map(number);
        assert_eq!(shown, ["0", "1", "0.2", "12345.7", "1.000e-9", "100000", "-0.05"]);
    }
}

//! The full-screen view of a run in a terminal: where it stands, a curve, the certificate, the attempts as they come.

use asperity::Error;
use asperity::error::visible;
use asperity::output::Request as Wish;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Block, Chart, Dataset, Gauge, GraphType, Paragraph, Row, Table, Wrap};
use ratatui::{DefaultTerminal, Frame};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Between two looks at the files of the run.
const REFRESH: Duration = Duration::from_millis(500);
/// Between two looks at the keyboard.
const LISTEN: Duration = Duration::from_millis(100);
/// Columns of `history.csv` that are no curves.
const PLACES: [&str; 3] = ["time", "step", "increment"];

/// Shows a run until a key or a signal ends the view; the run goes on.
///
/// # Errors
/// [`Error::Internal`] when the terminal refuses, [`Error::File`] when the results cannot be read at all.
pub fn show(directory: &Path, address: &str, stop: &AtomicBool) -> Result<(), Error> {
    let mut view = View::new(directory, address);
    view.refresh()?;
    let internal = |error: std::io::Error| Error::Internal(format!("the terminal: {error}"));
    let mut terminal = ratatui::try_init().map_err(internal)?;
    let ended = follow(&mut terminal, &mut view, stop);
    ratatui::restore();
    ended.map_err(internal)
}

fn follow(terminal: &mut DefaultTerminal, view: &mut View, stop: &AtomicBool) -> std::io::Result<()> {
    let mut looked = Instant::now();
    while !stop.load(Ordering::Relaxed) {
        terminal.draw(|frame| view.draw(frame))?;
        if event::poll(LISTEN)?
            && let Event::Key(key) = event::read()?
            && key.kind == KeyEventKind::Press
            && view.key(key)
        {
            break;
        }
        if looked.elapsed() > REFRESH {
            // A file that cannot be read now is read the next time; what was seen stays.
            if let Err(error) = view.refresh() {
                view.said = error.to_string();
            }
            looked = Instant::now();
        }
    }
    Ok(())
}

/// Rows of a table of the results that were read so far.
#[derive(Debug, Default)]
struct Rows {
    header: Vec<String>,
    columns: Vec<Vec<Value>>,
    next: u64,
}

impl Rows {
    fn refresh(&mut self, directory: &Path, table: &str) -> Result<(), Error> {
        let said = report::rows(directory, table, self.next)?;
        let read: Value = serde_json::from_str(&said).map_err(|error| Error::Internal(error.to_string()))?;
        let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
        let header: Vec<String> =
            list(&read["table"]["header"]).iter().filter_map(|name| Some(name.as_str()?.to_owned())).collect();
        let columns: Vec<Vec<Value>> = list(&read["table"]["columns"]).iter().map(list).collect();
        if read["from"].as_u64() == Some(0) || header != self.header {
            (self.header, self.columns) = (header, columns);
        } else {
            self.columns.iter_mut().zip(columns).for_each(|(old, new)| old.extend(new));
        }
        self.next = read["next"].as_u64().unwrap_or(0);
        Ok(())
    }

    fn column(&self, name: &str) -> &[Value] {
        let at = self.header.iter().position(|column| column == name);
        at.and_then(|at| self.columns.get(at)).map_or(&[], Vec::as_slice)
    }

    fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// A value as it is shown.
    fn cell(&self, row: usize, name: &str) -> String {
        match self.column(name).get(row) {
            Some(Value::Number(number)) => plain(number.as_f64().unwrap_or(f64::NAN)),
            Some(Value::String(text)) => visible(text).into_owned(),
            _ => String::new(),
        }
    }
}

/// A number in few signs.
fn plain(number: f64) -> String {
    match number.abs() {
        _ if number.fract() == 0.0 && number.abs() < 1e6 => format!("{number:.0}"),
        size if (1e-3..1e6).contains(&size) => {
            format!("{number:.*}", (4 - size.log10().floor().max(-1.0) as i32).max(0) as usize)
        }
        _ => format!("{number:.2e}"),
    }
}

/// What is shown.
struct View {
    directory: PathBuf,
    address: String,
    status: Value,
    history: Rows,
    increments: Rows,
    iterations: Rows,
    /// Number of the curve among [`View::curves`], once one was chosen.
    curve: Option<usize>,
    /// Whether the next key says if the run is to be stopped.
    asked: bool,
    said: String,
}

impl View {
    fn new(directory: &Path, address: &str) -> Self {
        let [history, increments, iterations] = std::array::from_fn(|_| Rows::default());
        let (directory, address) = (directory.to_owned(), address.to_owned());
        Self {
            directory,
            address,
            status: Value::Null,
            history,
            increments,
            iterations,
            curve: None,
            asked: false,
            said: String::new(),
        }
    }

    fn refresh(&mut self) -> Result<(), Error> {
        let status = report::status(&self.directory)?;
        self.status = serde_json::from_str(&status).map_err(|error| Error::Internal(error.to_string()))?;
        self.history.refresh(&self.directory, "history")?;
        self.increments.refresh(&self.directory, "increments")?;
        self.iterations.refresh(&self.directory, "iterations")
    }

    /// Takes a key; whether the view ends.
    fn key(&mut self, key: KeyEvent) -> bool {
        let control = key.modifiers.contains(KeyModifiers::CONTROL);
        let count = self.curves().count();
        let shown = self.shown();
        if std::mem::take(&mut self.asked) {
            let sure = matches!(key.code, KeyCode::Char('y' | 'Y'));
            self.said = if sure {
                self.wish(Wish::Stop, "the run ends after its increment, with a checkpoint")
            } else {
                String::new()
            };
            return false;
        }
        match key.code {
            KeyCode::Char('q') | KeyCode::Esc => return true,
            KeyCode::Char('c') if control => return true,
            KeyCode::Char('c') => {
                self.said = self.wish(Wish::Checkpoint, "a checkpoint is written after this increment")
            }
            KeyCode::Char('s') if self.runs() => {
                self.asked = true;
                self.said = "stop the run after its increment? y: yes, any other key: no".into();
            }
            KeyCode::Right | KeyCode::Tab if count > 0 => self.curve = Some((shown + 1) % count),
            KeyCode::Left | KeyCode::BackTab if count > 0 => self.curve = Some((shown + count - 1) % count),
            _ => {}
        }
        false
    }

    fn runs(&self) -> bool {
        self.status["runs"] == Value::Bool(true)
    }

    fn wish(&self, wish: Wish, said: &str) -> String {
        if !self.runs() {
            return "the run does not go on".into();
        }
        wish.leave(&self.directory).map_or_else(|error| error.to_string(), |()| said.into())
    }

    fn curves(&self) -> impl Iterator<Item = &String> {
        self.history.header.iter().filter(|name| !PLACES.contains(&name.as_str()))
    }

    /// Number of the curve that is shown: the chosen one, else a force of a contact, else a reaction, else the first.
    fn shown(&self) -> usize {
        let find = |wanted: fn(&str) -> bool| self.curves().position(|name| wanted(name));
        let first = || find(|name| name.ends_with(".thrust")).or_else(|| find(|name| name.starts_with("reaction.")));
        self.curve.or_else(first).unwrap_or(0)
    }

    fn draw(&self, frame: &mut Frame) {
        let rows = frame.area().height;
        let log = (rows / 3).clamp(3, 14);
        let [head, bar, middle, bottom, foot] = Layout::vertical([
            Constraint::Length(2),
            Constraint::Length(1),
            Constraint::Min(3),
            Constraint::Length(log),
            Constraint::Length(2),
        ])
        .areas(frame.area());
        let [left, right] = Layout::horizontal([Constraint::Percentage(62), Constraint::Min(24)]).areas(middle);
        self.draw_head(frame, head);
        self.draw_bar(frame, bar);
        self.draw_curve(frame, left);
        self.draw_trust(frame, right);
        self.draw_attempts(frame, bottom);
        self.draw_foot(frame, foot);
    }

    fn text(&self, key: &str) -> String {
        self.status["progress"][key].as_str().map(|text| visible(text).into_owned()).unwrap_or_default()
    }

    fn number(&self, key: &str) -> f64 {
        self.status["progress"][key].as_f64().unwrap_or(0.0)
    }

    fn draw_head(&self, frame: &mut Frame, area: Rect) {
        let status = match self.text("status") {
            // A summary that says so while nobody works at it is that of a process that was killed.
            status if status == "running" && !self.runs() => "killed".into(),
            status if status.is_empty() => "beginning".into(),
            status => status,
        };
        let color = match status.as_str() {
            "running" | "beginning" => Color::Cyan,
            "converged" => Color::Green,
            "doubtful" | "stopped" => Color::Yellow,
            _ => Color::Red,
        };
        let name = visible(&self.directory.display().to_string()).into_owned();
        let first = Line::from(vec![name.bold(), "  ".into(), Span::styled(status, Style::new().fg(color).bold())]);
        let (iterations, cuts) = (self.number("iterations"), self.number("cuts"));
        let second = format!(
            "step '{}' ({} of {}), increment {}, {iterations} iterations, {cuts} cuts, {} since the beginning",
            self.text("step"),
            self.number("step_number"),
            self.number("steps"),
            self.number("increment"),
            duration(self.number("elapsed")),
        );
        frame.render_widget(Paragraph::new(vec![first, Line::from(second)]), area);
    }

    fn draw_bar(&self, frame: &mut Frame, area: Rect) {
        let (time, end) = (self.number("time"), self.number("end_time"));
        let part = if end > 0.0 { (time / end).clamp(0.0, 1.0) } else { 0.0 };
        let left = self.status["progress"]["remaining"].as_f64().filter(|_| self.runs());
        let left = left.map_or_else(String::new, |left| format!(", {} left", duration(left)));
        let label = format!("time {} of {}{left}", plain(time), plain(end));
        frame.render_widget(Gauge::default().ratio(part).label(label).gauge_style(Style::new().fg(Color::Blue)), area);
    }

    fn draw_curve(&self, frame: &mut Frame, area: Rect) {
        let name = self.curves().nth(self.shown()).cloned().unwrap_or_default();
        let pair = |(x, y): (&Value, &Value)| Some((x.as_f64()?, y.as_f64()?));
        let points: Vec<(f64, f64)> =
            self.history.column("time").iter().zip(self.history.column(&name)).filter_map(pair).collect();
        let title = format!(" {} over time ", visible(&name));
        let block = Block::bordered().title(title);
        if points.is_empty() {
            frame.render_widget(Paragraph::new("no increment yet").block(block), area);
            return;
        }
        let bounds = |value: fn(&(f64, f64)) -> f64| {
            let range =
                points.iter().map(value).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
            // A curve that stays where it is still needs a height.
            if range[1] > range[0] {
                range
            } else {
                [range[0] - 0.5 * range[0].abs().max(1e-300), range[1] + 0.5 * range[1].abs().max(1e-300)]
            }
        };
        let (x, y) = (bounds(|point| point.0), bounds(|point| point.1));
        let curve = Dataset::default()
            .marker(Marker::Braille)
            .graph_type(GraphType::Line)
            .style(Style::new().fg(Color::Cyan))
            .data(&points);
        let axis = |bounds: [f64; 2]| Axis::default().bounds(bounds).labels(bounds.map(plain));
        frame.render_widget(Chart::new(vec![curve]).block(block).x_axis(axis(x)).y_axis(axis(y)), area);
    }

    fn draw_trust(&self, frame: &mut Frame, area: Rect) {
        let progress = &self.status["progress"];
        let mut lines = Vec::new();
        if let (Some(figure), Some(value)) = (progress["worst"][0].as_str(), progress["worst"][1]["value"].as_f64()) {
            let occasion = &progress["worst"][1];
            let limit = occasion["limit"].as_f64().map_or_else(String::new, |limit| format!(" of {}", plain(limit)));
            lines.push(Line::from(format!("nearest to its limit: {}", visible(figure))));
            let of = occasion["of"].as_str().unwrap_or_default();
            lines.push(Line::from(format!("  {}{limit}, {}", plain(value), visible(of))));
        }
        for figure in progress["beyond"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            lines.push(Line::from(format!("beyond its limit: {}", visible(figure))).yellow());
        }
        let cut = self.text("last_cut");
        if !cut.is_empty() {
            lines.push(Line::from(format!("last cut: {cut}")).yellow());
        }
        let worst = self.text("worst_unknown");
        if self.runs() && !worst.is_empty() {
            lines.push(Line::from(format!("largest unbalanced force: {worst}")));
        }
        let block = Block::bordered().title(" how far to trust it ");
        frame.render_widget(Paragraph::new(lines).wrap(Wrap { trim: false }).block(block), area);
    }

    fn draw_attempts(&self, frame: &mut Frame, area: Rect) {
        const COLUMNS: [&str; 9] =
            ["increment", "time", "dt", "iterations", "residual", "open", "stick", "slip", "reason"];
        let count = self.increments.len();
        let visible_rows = usize::from(area.height.saturating_sub(3));
        let row = |row: usize| {
            let cells: Vec<String> = COLUMNS.iter().map(|name| self.increments.cell(row, name)).collect();
            let cut = self.increments.cell(row, "accepted") == "0";
            Row::new(cells).style(if cut { Style::new().fg(Color::Yellow) } else { Style::new() })
        };
        let rows = (count.saturating_sub(visible_rows)..count).map(row);
        let widths: [Constraint; 9] = std::array::from_fn(|i| match i {
            8 => Constraint::Min(10),
            0 | 3 => Constraint::Length(10),
            _ => Constraint::Length(9),
        });
        let header = Row::new(COLUMNS).style(Style::new().add_modifier(Modifier::BOLD));
        let block = Block::bordered().title(" increments ").title_bottom(self.iteration());
        frame.render_widget(Table::new(rows, widths).header(header).block(block), area);
    }

    /// The last iteration, in words.
    fn iteration(&self) -> String {
        let Some(last) = self.iterations.len().checked_sub(1).filter(|_| self.runs()) else { return String::new() };
        let cell = |name: &str| self.iterations.cell(last, name);
        format!(" increment {}, iteration {}, residual {} ", cell("increment"), cell("iteration"), cell("residual"))
    }

    fn draw_foot(&self, frame: &mut Frame, area: Rect) {
        let keys = if self.runs() {
            "←/→ another curve   c checkpoint now   s stop the run   q leave (the run goes on)"
        } else {
            "←/→ another curve   q leave"
        };
        let first = if self.said.is_empty() { Line::from(keys).dim() } else { Line::from(self.said.as_str()).yellow() };
        frame.render_widget(Paragraph::new(vec![first, Line::from(self.address.as_str()).dim()]), area);
    }
}

/// Seconds in words.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 60.0 => format!("{s:.0} s"),
        s if s < 3600.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use serde_json::json;

    fn view() -> View {
        let mut view = View::new(Path::new("tube.results"), "http://127.0.0.1:1/?token=0");
        view.status = json!({ "runs": true, "frames": 2, "progress": {
            "status": "running", "step": "pu\u{1b}sh", "step_number": 1, "steps": 2, "increment": 3, "time": 0.5, "end_time": 2.0,
            "iterations": 12, "cuts": 1, "last_cut": "a cell folds", "worst_unknown": "node 3", "beyond": ["penetration"],
            "worst": ["penetration", { "value": 0.02, "limit": 0.01, "of": "contact 'bore'" }], "elapsed": 75.0, "remaining": 225.0,
        }});
        let numbers = |list: &[f64]| list.iter().map(|&x| json!(x)).collect::<Vec<_>>();
        view.history.header =
            ["time", "step", "increment", "energy.strain", "contact.bore.thrust"].map(str::to_owned).to_vec();
        let columns = [[0.1, 0.3, 0.5], [1.0; 3], [1.0, 2.0, 3.0], [0.0, 1.0, 4.0], [1.0, 2.0, 2.5]];
        view.history.columns = columns.iter().map(|column| numbers(column)).collect();
        view.increments.header = ["increment", "time", "accepted", "reason"].map(str::to_owned).to_vec();
        view.increments.columns = vec![
            numbers(&[3.0, 3.0]),
            numbers(&[0.6, 0.5]),
            numbers(&[0.0, 1.0]),
            vec![json!("a cell folds"), Value::Null],
        ];
        view
    }

    fn drawn(view: &View, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| view.draw(frame)).unwrap();
        let cells = terminal.backend().buffer().content.iter().map(|cell| cell.symbol().to_owned());
        cells.collect::<Vec<_>>().chunks(usize::from(width)).map(|row| row.concat() + "\n").collect()
    }

    fn press(view: &mut View, code: KeyCode) -> bool {
        view.key(KeyEvent::new(code, KeyModifiers::NONE))
    }

    #[test]
    fn what_there_is_to_know_of_a_run_is_shown() {
        let shown = drawn(&view(), 110, 34);
        for part in [
            "tube.results  running",
            "step 'pu?sh' (1 of 2), increment 3, 12 iterations, 1 cuts, 1 min",
            "time 0.5",
            "of 2, 4 min left",
            "contact.bore.thrust over time",
            "nearest to its limit: penetration",
            "contact 'bore'",
            "beyond its limit: penetration",
            "last cut: a cell folds",
            "s stop the run",
            "http://127.0.0.1:1/?token=0",
        ] {
            assert!(shown.contains(part), "'{part}' is not in\n{shown}");
        }
        assert!(!shown.contains('\u{1b}'));
    }

    #[test]
    fn a_view_of_any_size_and_of_nothing_is_drawn() {
        let nothing = View::new(Path::new("x"), "");
        for (width, height) in [(1, 1), (5, 3), (20, 8), (80, 24), (300, 90)] {
            drawn(&view(), width, height);
            drawn(&nothing, width, height);
        }
    }

    #[test]
    fn keys_choose_ask_and_leave() {
        let folder = tempfile::tempdir().unwrap();
        let mut view = view();
        view.directory = folder.path().into();
        assert!(!press(&mut view, KeyCode::Right));
        assert!(drawn(&view, 110, 34).contains("energy.strain over time"));
        assert!(!press(&mut view, KeyCode::Left));
        assert!(drawn(&view, 110, 34).contains("contact.bore.thrust over time"));
        press(&mut view, KeyCode::Char('s'));
        press(&mut view, KeyCode::Char('n'));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "the run was stopped without a yes");
        press(&mut view, KeyCode::Char('c'));
        assert!(folder.path().join("checkpoint.request").exists());
        press(&mut view, KeyCode::Char('s'));
        press(&mut view, KeyCode::Char('y'));
        assert!(folder.path().join("stop.request").exists());
        assert!(press(&mut view, KeyCode::Char('q')));
        assert!(view.key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL)));
    }
}

//! The standard pictures of a finished run, drawn from its files alone: contact stress on the deformed mesh, equivalent
//! stress, forces over travel, convergence.

use super::arrows::Arrow;
use super::curves;
use super::drawing::Drawing;
use super::panels::Panels;
use super::png;
use super::scene::Scene;
use super::shell::Tile;
use super::ticks::minus;
use super::view::{Projection, Window};
use crate::output::file::{Durability, write_atomic};
use crate::output::probe::{MEANS, or_means};
use crate::output::vtk::{DataArray, Grid, read_grid, read_series};
use crate::output::{Columns, Summary, Unit, Units};
use asperity_core::Error;
use asperity_core::declare::nearest;
use asperity_core::mesh::Mesh;
use std::path::{Path, PathBuf};

/// What is drawn, and how large.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureOptions {
    /// Times of the frames shown side by side; the nearest written ones are taken. Empty: four, evenly over the run.
    pub times: Vec<f64>,
    /// What of the plane is shown; everything where not given.
    pub window: Option<Window>,
    /// Pixels of the PNG a point of the page.
    pub resolution: f64,
    /// A quantity at the nodes that is drawn in a picture of its own, in place of all others: `displacement.y`.
    pub quantity: Option<String>,
    /// Whether a film of this quantity, or of von Mises' stress, is drawn in place of pictures: an animated PNG.
    pub film: bool,
}

impl Default for FigureOptions {
    fn default() -> Self {
        Self { times: Vec::new(), window: None, resolution: 2.0, quantity: None, film: false }
    }
}

/// Frames shown side by side where no times are given,
const PANELS: usize = 4;
/// and frames of a film, at most.
const FILM: usize = 100;

/// Draws the standard pictures into the directory of the results and returns their files.
///
/// # Errors
/// [`Error::File`] when a result cannot be read, or a picture not written; [`Error::Input`] for a time at which the run
/// was not, and for a window of a run in space.
pub fn draw_standard(directory: &Path, options: &FigureOptions) -> Result<Vec<PathBuf>, Error> {
    let run = Run { directory, summary: Summary::read(&directory.join("summary.json"))?, options };
    if options.window.is_some() && run.summary.space == "solid" {
        return Err(Error::Input("a window is a part of the plane; this run is in space and is shown whole".into()));
    }
    let mut written = Vec::new();
    let mut save = |name: &str, drawing: Drawing| -> Result<(), Error> {
        let (svg, png) = (directory.join(format!("{name}.svg")), directory.join(format!("{name}.png")));
        write_atomic(&svg, drawing.to_svg().as_bytes(), Durability::Process)?;
        write_atomic(&png, &drawing.to_png(options.resolution)?, Durability::Process)?;
        written.extend([svg, png]);
        Ok(())
    };
    let shots = run.shots()?;
    if options.film || options.quantity.is_some() {
        let quantity = options.quantity.as_deref().unwrap_or("von_mises_averaged");
        let Some(last) = shots.last() else {
            return Err(Error::file(directory.join("bodies.pvd"), "there is no frame to draw"));
        };
        last.values(quantity)?;
        let file: String = quantity.chars().filter(|c| c.is_ascii_alphanumeric() || "._-".contains(*c)).collect();
        let panels = run.panels(&quantity.replace('_', " "), quantity, &shots);
        let unit = match (dimension(quantity), run.units()) {
            (Some(unit), Some(units)) => format!(" ({})", Units::label(Some(&units), unit)),
            _ => String::new(),
        };
        let panels = Panels { field_name: format!("{}, at nodes{unit}", quantity.replace('_', " ")), ..panels };
        if !options.film {
            save(&file, panels.draw())?;
            return Ok(written);
        }
        let path = directory.join(format!("{file}_film.png"));
        write_atomic(&path, &png::film(panels.film(), options.resolution)?, Durability::Process)?;
        return Ok(vec![path]);
    }
    if !shots.is_empty() {
        if !run.summary.contact_order.is_empty() {
            save("contact_stress", run.panels("Contact stress", "", &shots).draw())?;
        }
        save("von_mises", run.panels("Equivalent stress", "von_mises_averaged", &shots).draw())?;
    }
    let table = |name: &str| {
        let path = directory.join(name);
        if path.exists() { Columns::read(&path) } else { Ok(Columns::default()) }
    };
    let axisymmetric = run.summary.space == "axisymmetric";
    let units = run.units();
    if let Some(chart) = curves::forces(&table("history.csv")?, &run.summary.title, axisymmetric, units.as_ref()) {
        save("forces", chart.draw())?;
    }
    if let Some(chart) = curves::convergence(&table("iterations.csv")?) {
        save("convergence", chart.draw())?;
    }
    Ok(written)
}

/// The files of one run.
struct Run<'a> {
    directory: &'a Path,
    summary: Summary,
    options: &'a FigureOptions,
}

/// One frame, read back.
struct Shot {
    time: f64,
    mesh: Mesh,
    bodies: Grid,
    arrows: Vec<Arrow>,
    tools: Vec<Vec<[f64; 3]>>,
    shells: Vec<Tile>,
}

impl Run<'_> {
    /// The frames to be shown.
    fn shots(&self) -> Result<Vec<Shot>, Error> {
        let series = |name: &str| {
            let path = self.directory.join(format!("{name}.pvd"));
            if path.exists() { read_series(&path) } else { Ok(Vec::new()) }
        };
        let (bodies, contacts, tools) = (series("bodies")?, series("contacts")?, series("tools")?);
        let at = |series: &[(f64, String)], time: f64| {
            let frame = series.iter().find(|(at, _)| *at == time);
            frame.map_or(Ok(Grid::default()), |(_, file)| read_grid(&self.directory.join(file)))
        };
        let times: Vec<f64> = bodies.iter().map(|(time, _)| *time).collect();
        let all = if self.options.film { FILM } else { PANELS };
        let chosen = chosen(&times, &self.options.times, all)?.into_iter();
        chosen.map(|time| shot(time, at(&bodies, time)?, &at(&contacts, time)?, &at(&tools, time)?)).collect()
    }

    /// Names of the units.
    fn units(&self) -> Option<Units> {
        self.summary.units.as_ref().and_then(|text| Units::parse(text).ok())
    }

    fn panels<'b>(&self, title: &str, field: &str, shots: &'b [Shot]) -> Panels<'b> {
        let solid = self.summary.space == "solid";
        let axes = if self.summary.space == "axisymmetric" { ["r", "z"] } else { ["x", "y"] };
        let units = self.units();
        let stress = Units::label(units.as_ref(), Unit::Stress);
        let length = units.map_or(String::new(), |units| format!(" ({})", units.name(Unit::Length)));
        let title = match self.summary.title.as_str() {
            "" => title.to_string(),
            own => format!("{own}: {}", title.to_lowercase()),
        };
        Panels {
            title,
            scenes: shots.iter().map(|shot| shot.scene(field)).collect(),
            projection: if solid { Projection::Corner } else { Projection::Plane },
            axes: axes.map(|axis| format!("{axis}{length}")),
            arrow_name: format!("contact stress ({stress}){}", if solid { ", pale behind a body" } else { "" }),
            field_name: format!("von Mises stress, mean at nodes ({stress})"),
            window: self.options.window,
            room: [900.0, 760.0],
        }
    }
}

/// The dimension of a quantity at nodes, whose file does not say it; none for a pure number.
fn dimension(quantity: &str) -> Option<Unit> {
    let name = quantity.split('.').next().unwrap_or(quantity).trim_end_matches(MEANS);
    Some(match name {
        "displacement" | "contact_gap" | "contact_slip" => Unit::Length,
        "reaction" | "load" => Unit::Force,
        "cauchy_stress" | "von_mises" | "pressure" | "contact_pressure" | "contact_shear" => Unit::Stress,
        _ => return None,
    })
}

/// Components of arrays of so many numbers a node, by their names.
const VECTOR: [&str; 3] = ["x", "y", "z"];
const SYMMETRIC: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

impl Shot {
    /// A quantity at the nodes: a number, a component (`displacement.y`), or the length of a vector.
    fn values(&self, quantity: &str) -> Result<Vec<f64>, Error> {
        let names = || self.bodies.point_data.iter().map(|array| array.name.as_str());
        let find = |name: &str| or_means(name, |name| self.bodies.point_array(name));
        let (name, component) = match quantity.rsplit_once('.') {
            Some((name, component)) if find(quantity).is_none() => (name, Some(component)),
            _ => (quantity, None),
        };
        let Some(array) = find(name) else {
            let near = nearest(name, names()).map_or("; ".to_owned(), |near| format!("; did you mean `{near}`? "));
            let all = names().collect::<Vec<_>>().join(", ");
            return Err(Error::input(format!("there is no quantity `{name}` at the nodes{near}there are {all}")));
        };
        let (values, width) = (array.values.to_real(), array.components);
        let words: &[&str] = match width {
            3 => &VECTOR,
            6 => &SYMMETRIC,
            _ => &[],
        };
        let place = component.map(|component| words.iter().position(|word| *word == component));
        match (width, place) {
            (1, None) => Ok(values),
            (3, None) => {
                Ok(values.as_chunks::<3>().0.iter().map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt()).collect())
            }
            (_, Some(Some(place))) => Ok(values.chunks_exact(width).map(|tuple| tuple[place]).collect()),
            (1, _) => Err(Error::input(format!("`{name}` is a single number and has no components"))),
            _ => Err(Error::input(format!("`{name}` is drawn by component: {}", words.join(", ")))),
        }
    }
    fn scene(&self, field: &str) -> Scene<'_> {
        let field = if field.is_empty() { None } else { self.values(field).ok() };
        Scene {
            title: format!("time {}", minus(&super::ticks::short(self.time))),
            mesh: &self.mesh,
            points: moved(&self.bodies),
            field,
            arrows: self.arrows.clone(),
            tools: self.tools.clone(),
            shells: self.shells.clone(),
        }
    }
}

/// The written times nearest to the wanted ones; `count` evenly spread ones where none are wanted, the first left out. A time
/// at which the run was not is refused.
fn chosen(times: &[f64], wanted: &[f64], count: usize) -> Result<Vec<f64>, Error> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Ok(Vec::new()) };
    let slack = 1e-9 * (last - first);
    if let Some(lost) = wanted.iter().find(|&&want| !(want >= first - slack && want <= last + slack)) {
        let [first, last] = [*first, *last].map(super::ticks::short);
        return Err(Error::Input(format!("there is no frame at time {lost}: this run goes from {first} to {last}")));
    }
    let shown = if wanted.is_empty() && times.len() > 1 { &times[1..] } else { times };
    let even = (1..=count).map(|i| first + (last - first) * i as f64 / count as f64).collect();
    let wanted = if wanted.is_empty() { even } else { wanted.to_vec() };
    let near = |&want: &f64| shown.iter().copied().min_by(|a, b| (a - want).abs().total_cmp(&(b - want).abs()));
    let mut found: Vec<f64> = wanted.iter().filter_map(near).collect();
    found.dedup();
    Ok(found)
}

fn shot(time: f64, bodies: Grid, contacts: &Grid, tools: &Grid) -> Result<Shot, Error> {
    let (arrows, shells) = (arrows(contacts), tiles(tools));
    Ok(Shot { time, mesh: bodies.to_mesh()?, arrows, tools: profiles(tools), shells, bodies })
}

/// Present positions of a grid's points.
fn moved(grid: &Grid) -> Vec<[f64; 3]> {
    let by = vectors(grid.point_array("displacement"));
    let shift = |(i, p): (usize, &[f64; 3])| by.get(i).map_or(*p, |u| std::array::from_fn(|a| p[a] + u[a]));
    grid.points.iter().enumerate().map(shift).collect()
}

fn vectors(array: Option<&DataArray>) -> Vec<[f64; 3]> {
    array.filter(|a| a.components == 3).map_or(Vec::new(), |a| a.values.to_real().as_chunks().0.to_vec())
}

/// The stress vectors of all contact points; those of open ones are zero.
fn arrows(contacts: &Grid) -> Vec<Arrow> {
    let traction = vectors(contacts.point_array("contact_traction"));
    let number = contacts.point_array("contact").map_or(Vec::new(), |a| a.values.to_real());
    let group = |i: usize| number.get(i).map_or(0, |&n| n as usize);
    let all = moved(contacts).into_iter().zip(traction).enumerate();
    all.map(|(i, (at, vector))| Arrow { at, vector, group: group(i) }).collect()
}

/// Lines that follow each other, joined.
fn profiles(tools: &Grid) -> Vec<Vec<[f64; 3]>> {
    let points = moved(tools);
    let mut profiles: Vec<Vec<[f64; 3]>> = Vec::new();
    let mut end = None;
    for (_, nodes) in tools.cells.iter().flatten().filter(|(_, nodes)| nodes.len() == 2) {
        let ends: Vec<usize> = nodes.iter().filter_map(|&n| usize::try_from(n).ok()).collect();
        let (Some(&from), Some(&to)) = (ends.first(), ends.get(1)) else { continue };
        let (Some(&a), Some(&b)) = (points.get(from), points.get(to)) else { continue };
        match profiles.last_mut() {
            Some(profile) if end == Some(from) => profile.push(b),
            _ => profiles.push(vec![a, b]),
        }
        end = Some(to);
    }
    profiles
}

/// The tiles of tools in space.
fn tiles(tools: &Grid) -> Vec<Tile> {
    let points = moved(tools);
    let corner = |&n: &i64| usize::try_from(n).ok().and_then(|n| points.get(n).copied());
    let tiles = tools.cells.iter().flatten().filter(|(_, nodes)| nodes.len() > 2);
    tiles.filter_map(|(_, nodes)| nodes.iter().map(corner).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_chosen_by_time() {
        let times: Vec<f64> = (0..=10).map(|i| 0.1 * f64::from(i)).collect();
        assert_eq!(chosen(&times, &[], PANELS).unwrap(), [times[2], times[5], times[7], times[10]]);
        assert_eq!(chosen(&times, &[0.29, 0.31, 0.9], PANELS).unwrap(), [times[3], times[9]]);
        assert_eq!(chosen(&[0.0, 1.0, 2.0], &[], FILM).unwrap(), [1.0, 2.0], "the beginning is not shown unasked");
        assert!(chosen(&[], &[0.5], PANELS).unwrap().is_empty());
        for lost in [-0.1, 1.01, f64::NAN] {
            let refused = chosen(&times, &[0.5, lost], PANELS).unwrap_err().to_string();
            assert!(refused.contains("goes from 0 to 1"), "{refused}");
        }
    }

    #[test]
    fn lines_that_follow_each_other_are_one_profile() {
        let mut grid = Grid { points: (0..5).map(|i| [f64::from(i), 0.0, 0.0]).collect(), ..Grid::default() };
        [[0, 1], [1, 2], [3, 4]].into_iter().for_each(|line| grid.cells.push(3, line));
        let profiles = profiles(&grid);
        assert_eq!(profiles.iter().map(Vec::len).collect::<Vec<_>>(), [3, 2]);
        grid.cells.push(5, [0, 2, 4]);
        assert_eq!(tiles(&grid), [vec![[0.0; 3], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]]);
    }
}

//! No key is read and ignored: another value of any key makes another model. The good decks of `tests/decks` are built
//! with each of their values changed in turn, and models are compared by all that their solution depends on: mesh,
//! steps, options, and the forces of every term in every step at trial states that close and slide the contacts. Keys
//! of the solver and of the output must besides change what a run does and leaves.

mod model_print;
mod schema_sites;

use asperity::Failure;
use asperity::deck::schema::{Names, Schema, root};
use asperity::deck::{Loaded, build, read};
use asperity::material::external::{Call, Library, UserLaw, provide};
use asperity::solve::{Frontal, engine};
use model_print::{print, run_print};
use schema_sites::{Site, Step, at, decks, folder, last_key, parent, sites};
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;
use toml::Value;

/// A changed deck as text and, unless it is refused, read.
fn loaded(deck: &Value) -> Option<Loaded> {
    read(&toml::to_string(deck).unwrap(), "changed.toml", &folder(), &[]).ok()
}

fn model(deck: &Value) -> Option<u64> {
    provide(stand_in);
    engine::provide(|problem| Box::new(Frontal::new(problem.newton.factors).within(problem.newton.memory)), || None);
    build(loaded(deck)?).ok().map(|made| print(&made))
}

/// What stands for a law of a library: it is as stiff as all that is said of it, and tells a tangent that is not its own.
struct StandIn(u64);

fn stand_in(library: &Library) -> Result<Arc<dyn UserLaw>, String> {
    let mut all = DefaultHasher::new();
    format!("{library:?}").hash(&mut all);
    Ok(Arc::new(StandIn(all.finish() % 1_000_003)))
}

impl UserLaw for StandIn {
    fn name(&self) -> &str {
        "the stand-in"
    }
    fn call(&self, call: &mut Call) -> Result<(), Failure> {
        let stiffness = 1.0 + self.0 as f64 + 0.1 * call.states.iter().sum::<f64>() + call.states.len() as f64;
        (0..call.components).for_each(|i| call.stress[i] += stiffness * call.strain[1][i]);
        (0..call.components).for_each(|i| call.tangent[i + i * call.components] = 2.0 * stiffness);
        Ok(())
    }
}

/// Other values that the schema allows.
fn others(schema: &Schema, value: &Value, names: &[String]) -> Vec<Value> {
    match schema {
        Schema::Number { range, .. } => {
            let x = value.as_float().or(value.as_integer().map(|x| x as f64)).unwrap();
            let all = [1.1 * x, 0.9 * x, x + 0.01, x - 0.01, x + 0.6, x - 0.6, x + 3.0, x - 3.0, 2.0 * x, 0.5 * x];
            all.into_iter().filter(|&y| y != x && range.contains(y)).map(Value::from).collect()
        }
        Schema::Whole { least, most } => {
            let x = value.as_integer().unwrap();
            let allowed = |y: &i64| (*least..=*most).contains(&u64::try_from(*y).unwrap());
            [x + 1, x - 1, 2 * x].into_iter().filter(allowed).map(Value::from).collect()
        }
        Schema::Flag => vec![(!value.as_bool().unwrap()).into()],
        Schema::Text("the path of a mesh file") => vec!["../meshes/plane2-41a.msh".into()],
        Schema::Text("the path of a shared library") => vec!["tie.toml".into()],
        Schema::Text("names of units") => vec!["kN, m".into()],
        Schema::Text("the name of a quantity") => {
            vec!["displacement".into(), "cauchy_stress".into(), "contact_gap".into()]
        }
        Schema::Text("the path of an STL file") => vec!["../meshes/cube2.stl".into()],
        Schema::Text(_) => vec!["another".into()],
        Schema::Word(words) => words.iter().map(|(word, _)| Value::from(*word)).filter(|word| word != value).collect(),
        Schema::Name(_) => names.iter().map(|name| Value::from(name.as_str())).filter(|name| name != value).collect(),
        _ => vec![],
    }
}

/// Every name that stands in a deck or its mesh, and the conditions of its steps.
fn names(deck: &Value) -> BTreeMap<bool, Vec<String>> {
    let loaded = loaded(deck).unwrap();
    let given = |key: &str| deck.get(key).and_then(Value::as_table).into_iter().flat_map(|table| table.keys().cloned());
    let groups = loaded.mesh.groups.keys().cloned();
    let given = ["material", "tool", "contact", "distributing"].into_iter().flat_map(given);
    let plain = groups.chain(given).collect();
    let conditions = loaded.deck.step.iter().flat_map(|step| step.conditions()).map(|(path, _)| path).collect();
    BTreeMap::from([(false, plain), (true, conditions)])
}

/// The decks with the value of one site changed in each way that the schema allows.
fn changed(deck: &Value, site: &Site, names: &BTreeMap<bool, Vec<String>>) -> Vec<Value> {
    let old = at(&mut deck.clone(), &site.path).clone();
    let condition = matches!(site.schema, Schema::Name(Names::Condition));
    let mut all = Vec::new();
    for value in others(&site.schema, &old, &names[&condition]) {
        all.push(deck.clone());
        *at(all.last_mut().unwrap(), &site.path) = value;
    }
    if let Some((_, false)) = site.name {
        let key = last_key(&site.path);
        for other in names[&false].iter().filter(|other| **other != key) {
            let mut deck = deck.clone();
            let table = parent(&mut deck, &site.path);
            let value = table.remove(&key).unwrap();
            if table.insert(other.clone(), value).is_none() {
                all.push(deck);
            }
        }
    }
    all
}

/// The paths of all values that have no parts, with names and positions left out; and of tables whose keys are names of
/// something, which may name something else.
fn all(schema: &Schema, path: &str, found: &mut BTreeSet<String>) {
    match schema {
        Schema::Table(keys) | Schema::OneOf(keys) => {
            keys.iter().for_each(|key| all(&key.schema, &format!("{path}.{}", key.name), found));
        }
        Schema::Map { item, defines, .. } => {
            found.extend((!defines).then(|| format!("{path}.NAME")));
            all(item, &format!("{path}.NAME"), found);
        }
        Schema::List { item, .. } => all(item, &format!("{path}.ITEM"), found),
        _ => drop(found.insert(path.to_owned())),
    }
}

fn plain(path: &[Step], named: &[Vec<Step>]) -> String {
    let word = |i: usize| match &path[i] {
        Step::Item(_) => "ITEM",
        Step::Key(_) if named.iter().any(|name| name[..] == path[..=i]) => "NAME",
        Step::Key(key) => key,
    };
    (0..path.len()).fold(String::new(), |text, i| text + "." + word(i))
}

#[test]
fn every_key_changes_the_model() {
    let mut idle = BTreeSet::new();
    all(&root(), "", &mut idle);
    assert!(idle.len() > 100, "{}", idle.len());
    for (_, table) in decks() {
        let deck = Value::Table(table);
        let (before, names, mut found) = (model(&deck).expect("a good deck"), names(&deck), Vec::new());
        sites(&deck, &root(), &[], &mut found);
        let named: Vec<_> = found.iter().filter(|site| site.name.is_some()).map(|site| site.path.clone()).collect();
        for site in &found {
            let path = plain(&site.path, &named);
            if idle.contains(&path) && changed(&deck, site, &names).iter().filter_map(model).any(|now| now != before) {
                idle.remove(&path);
            }
        }
    }
    // There is one version so far, and no other to compare with.
    assert!(idle.remove(".version"));
    // Where nothing bears yet a fluid comes everywhere: `tests/fluids.rs` has contact that does.
    assert!(idle.remove(".step.ITEM.pressure.NAME.from"));
    assert!(idle.is_empty(), "read and ignored: {idle:#?}");
}

#[test]
fn a_deck_makes_the_same_model_every_time() {
    for (name, table) in decks() {
        let deck = Value::Table(table);
        assert_eq!(model(&deck), model(&deck), "{name}");
    }
}

/// A block is pressed onto a plate and drawn along it.
const RUN: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad4" }
material.rubber.elastic = { young = 10.0, poisson = 0.3 }
body.block.material = "rubber"
tool.plate.profile = [{ line = [[9.0, -0.1], [-9.0, -0.05]] }]
contact.base = { surface = "block.bottom", target = "plate", elastic_slip = 1e-6, law.coulomb = { friction = 0.3 } }
solver = { tolerance = 1e-6 }
[[step]]
increments = { first = 0.2, largest = 0.2 }
displacement."block.top" = { x = 0.0, y = -0.4 }
[[step]]
increments = { first = 0.2, largest = 0.2 }
displacement."block.top" = { x = 0.5, y = -0.4 }
"#;

#[test]
fn keys_of_solver_and_output_change_the_run() {
    let run = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        let made =
            read(RUN, "run.toml", &folder(), &sets).and_then(build).unwrap_or_else(|d| panic!("{}", d.render(false)));
        run_print(&made)
    };
    let plain = run(&[]);
    assert!(plain.0, "the run does not converge");
    assert_eq!(plain, run(&[]));
    let changes = [
        "solver.newton=modified",
        "solver.tangent=perturbation",
        "solver.tolerance=1e-10",
        "solver.iterations=2",
        "solver.piecewise=false",
        "output.every=3",
        "output.pictures=false",
        "output.checkpoints=steps",
        "output.export=[\"frd\"]",
        "output.export=[\"deformed\"]",
        "output.print=[{of.nodes=\"block.top\",quantities=[\"reaction\"]}]",
        "probe.top={at.group=\"block.top\",quantities=[\"reaction\"]}",
        "step.1.increments.most=2",
        "step.1.increments.first=0.1",
        "step.1.increments.largest=0.3",
        "step.2.duration=2",
    ];
    for change in changes {
        assert_ne!(plain, run(&[change]), "{change}");
    }
    // At the end only the last checkpoint is there, unless all are kept.
    let all = "output.checkpoints=all";
    assert_ne!(run(&[all]), run(&[all, "output.checkpoint_every=4"]));
    // Full corrections serve that run well; the search has work where points find out one by one about a ridge.
    let ridge = "{ line = [[9.0, -1.0], [2.2, 0.0]] }, { line = [[2.2, 0.0], [-9.0, -5.0]] }";
    let hard = [&*format!("tool.plate.profile=[{ridge}]"), "solver.piecewise=false"];
    assert_ne!(run(&hard), run(&[&hard[..], &["solver.line_search=false"]].concat()));
}

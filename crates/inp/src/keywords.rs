//! Every keyword that is known: what it says, its parameters, and what is done with it. Reader, checks and the manual's
//! table come from these declarations.

use crate::read::Reader;
use crate::source::Block;
use std::fmt::Write;

/// What is done with a keyword.
pub enum Treated {
    /// Nodes and elements: read before all others.
    Mesh(fn(&mut Reader, &Block)),
    /// Read.
    Read(fn(&mut Reader, &Block)),
    /// Read after all others, since it names what may stand below it.
    Late(fn(&mut Reader, &Block)),
    /// Part of the structure of the deck itself.
    Structure,
    /// Left out, since the answer does not depend on it; why.
    Left(&'static str),
    /// Refused: what to do instead.
    Refused(&'static str),
}

/// Where a keyword may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Where {
    /// Before the first step.
    Model,
    /// Within a step.
    Step,
    /// Anywhere.
    Anywhere,
}

/// A parameter of a keyword.
pub struct Parameter {
    /// In capitals.
    pub name: &'static str,
    /// What is done with it.
    pub treated: Value,
}

/// What is done with a parameter.
pub enum Value {
    /// Used, whatever its value.
    Used,
    /// One of these words, or nothing.
    OneOf(&'static [&'static str]),
    /// Left out; the answer does not depend on it.
    Left,
    /// Left out, with a note that says what it changes.
    Noted(&'static str),
    /// Refused: what to do instead.
    Refused(&'static str),
}

/// A keyword.
pub struct Keyword {
    /// In capitals.
    pub name: &'static str,
    /// Where it may stand.
    pub place: Where,
    /// What is done with it.
    pub treated: Treated,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// What becomes of it, for the manual.
    pub becomes: &'static str,
}

const fn used(name: &'static str) -> Parameter {
    Parameter { name, treated: Value::Used }
}

const fn one_of(name: &'static str, words: &'static [&'static str]) -> Parameter {
    Parameter { name, treated: Value::OneOf(words) }
}

const fn left(name: &'static str) -> Parameter {
    Parameter { name, treated: Value::Left }
}

const fn noted(name: &'static str, what: &'static str) -> Parameter {
    Parameter { name, treated: Value::Noted(what) }
}

const fn refused(name: &'static str, instead: &'static str) -> Parameter {
    Parameter { name, treated: Value::Refused(instead) }
}

const fn of_model(
    name: &'static str,
    read: fn(&mut Reader, &Block),
    parameters: &'static [Parameter],
    becomes: &'static str,
) -> Keyword {
    Keyword { name, place: Where::Model, treated: Treated::Read(read), parameters, becomes }
}

const fn late(
    name: &'static str,
    read: fn(&mut Reader, &Block),
    parameters: &'static [Parameter],
    becomes: &'static str,
) -> Keyword {
    Keyword { name, place: Where::Model, treated: Treated::Late(read), parameters, becomes }
}

const fn of_step(
    name: &'static str,
    read: fn(&mut Reader, &Block),
    parameters: &'static [Parameter],
    becomes: &'static str,
) -> Keyword {
    Keyword { name, place: Where::Step, treated: Treated::Read(read), parameters, becomes }
}

const fn structure(name: &'static str, parameters: &'static [Parameter], becomes: &'static str) -> Keyword {
    Keyword { name, place: Where::Model, treated: Treated::Structure, parameters, becomes }
}

const fn without_effect(name: &'static str, why: &'static str) -> Keyword {
    Keyword { name, place: Where::Anywhere, treated: Treated::Left(why), parameters: &[], becomes: "" }
}

const fn no(name: &'static str, instead: &'static str) -> Keyword {
    Keyword { name, place: Where::Anywhere, treated: Treated::Refused(instead), parameters: &[], becomes: "" }
}

/// Parameters without a value that may stand on a line of their own.
pub const FLAGS: [&str; 4] = ["GENERATE", "INTERNAL", "UNSORTED", "NLGEOM"];

const INSTANCES: &str = "list the members, or put the set into the part";
const COURSE: [Parameter; 2] = [used("AMPLITUDE"), one_of("OP", &["MOD", "NEW"])];
const COMPLEX: &str = "only real, static loads are read; leave it out";
const TABLE_OF_TEMPERATURE: &str = "give one row of constants";
const OUTPUT: &str = "all fields are written to VTU, reactions and contact forces to tables";
const STATIC_ONLY: &str = "only *STATIC steps can be solved";
const SOLIDS_ONLY: &str = "bodies are made of solid, plane or axisymmetric cells with a *SOLID SECTION";
const BY_HAND: &str = "the deck of Asperity has laws of this kind: write the material there by hand";
const CONSTRAINTS: &str = "constraints between nodes cannot be solved; mesh the parts as one, or glue them by a *CONTACT PAIR in \
                           the deck of Asperity with law.cohesive";
const PAIRS_ONLY: &str = "name the surfaces in a *CONTACT PAIR";
const BEGINNING: &str = "only temperatures can be given at the beginning; stresses: `initial_stress` of a body";

/// All keywords, in the order of the manual.
pub static KEYWORDS: &[Keyword] = &[
    Keyword {
        name: "HEADING",
        place: Where::Model,
        treated: Treated::Read(Reader::heading),
        parameters: &[],
        becomes: "`title`",
    },
    structure("INCLUDE", &[used("INPUT")], "the file is read in its place"),
    structure("PART", &[used("NAME")], "laid out by its instances"),
    structure("END PART", &[], ""),
    structure("ASSEMBLY", &[left("NAME")], "instances, their sets called `INSTANCE.SET`"),
    structure("END ASSEMBLY", &[], ""),
    structure(
        "INSTANCE",
        &[used("NAME"), used("PART"), refused("LIBRARY", "copy the part into this deck")],
        "its nodes, shifted and turned",
    ),
    structure("END INSTANCE", &[], ""),
    Keyword {
        name: "NODE",
        place: Where::Model,
        treated: Treated::Mesh(Reader::nodes),
        parameters: &[used("NSET"), used("INPUT"), one_of("SYSTEM", &["R"])],
        becomes: "nodes of the mesh",
    },
    Keyword {
        name: "ELEMENT",
        place: Where::Model,
        treated: Treated::Mesh(Reader::elements),
        parameters: &[used("TYPE"), used("ELSET"), used("INPUT"), refused("OFFSET", "write the elements out")],
        becomes: "cells of the mesh",
    },
    of_model(
        "NSET",
        Reader::node_set,
        &[
            used("NSET"),
            used("ELSET"),
            used("GENERATE"),
            used("INSTANCE"),
            used("INTERNAL"),
            left("UNSORTED"),
            used("INPUT"),
        ],
        "group of nodes",
    ),
    of_model(
        "ELSET",
        Reader::element_set,
        &[used("ELSET"), used("GENERATE"), used("INSTANCE"), used("INTERNAL"), left("UNSORTED"), used("INPUT")],
        "group of cells",
    ),
    of_model(
        "SURFACE",
        Reader::surface,
        &[
            used("NAME"),
            one_of("TYPE", &["ELEMENT", "NODE", "SEGMENTS", "CYLINDER", "REVOLUTION"]),
            used("FILLET RADIUS"),
            used("INTERNAL"),
            refused("COMBINE", INSTANCES),
            refused("CROP", INSTANCES),
        ],
        "group of sides; with SEGMENTS, CYLINDER, REVOLUTION the profile of a tool",
    ),
    late(
        "RIGID BODY",
        Reader::rigid_body,
        &[
            used("REF NODE"),
            used("ANALYTICAL SURFACE"),
            used("ELSET"),
            used("NSET"),
            used("ROT NODE"),
            refused("PIN NSET", "give the rigid elements by ELSET"),
            refused("TIE NSET", "give the rigid elements by ELSET"),
            noted("POSITION", "the reference point stays where its node is"),
            refused("ISOTHERMAL", "leave it out"),
        ],
        "`tool`; nodes of a body whose reference node is led in all directions: `displacement`",
    ),
    of_model("MATERIAL", Reader::material, &[used("NAME")], "`material`"),
    of_model(
        "ELASTIC",
        Reader::elastic,
        &[
            one_of("TYPE", &["ISO", "ISOTROPIC"]),
            one_of("MODULI", &["LONG TERM", "INSTANTANEOUS"]),
            refused("DEPENDENCIES", TABLE_OF_TEMPERATURE),
        ],
        "`elastic`",
    ),
    of_model(
        "PLASTIC",
        Reader::plastic,
        &[
            one_of("HARDENING", &["ISOTROPIC", "KINEMATIC"]),
            refused("RATE", BY_HAND),
            refused("DEPENDENCIES", TABLE_OF_TEMPERATURE),
        ],
        "`von_mises_table`, `von_mises`",
    ),
    of_model(
        "HYPERELASTIC",
        Reader::hyperelastic,
        &[
            used("NEO HOOKE"),
            used("MOONEY-RIVLIN"),
            used("YEOH"),
            used("OGDEN"),
            used("ARRUDA-BOYCE"),
            used("POLYNOMIAL"),
            used("REDUCED POLYNOMIAL"),
            used("N"),
            one_of("MODULI", &["LONG TERM", "INSTANTANEOUS"]),
            refused("TEST DATA INPUT", "fit the constants first and give them"),
            refused("MARLOW", "fit NEO HOOKE, MOONEY-RIVLIN, YEOH or OGDEN"),
            refused("VAN DER WAALS", "fit NEO HOOKE, MOONEY-RIVLIN, YEOH or OGDEN"),
        ],
        "`neo_hookean`, `mooney_rivlin`, `yeoh`, `ogden`, `arruda_boyce`",
    ),
    of_model("DENSITY", Reader::density, &[refused("DEPENDENCIES", TABLE_OF_TEMPERATURE)], "weight under GRAV"),
    of_model(
        "EXPANSION",
        Reader::expansion,
        &[one_of("TYPE", &["ISO", "ISOTROPIC"]), used("ZERO"), refused("DEPENDENCIES", TABLE_OF_TEMPERATURE)],
        "`expansion`",
    ),
    late(
        "SOLID SECTION",
        Reader::solid_section,
        &[
            used("ELSET"),
            used("MATERIAL"),
            left("CONTROLS"),
            refused("ORIENTATION", "all laws are isotropic: leave it out where the material is, too"),
            refused("COMPOSITE", "give each layer its own elements"),
            noted("NODAL THICKNESS", "the thickness of the data line holds"),
        ],
        "`body`",
    ),
    of_model(
        "AMPLITUDE",
        Reader::amplitude,
        &[
            used("NAME"),
            one_of("TIME", &["STEP TIME", "TOTAL TIME"]),
            one_of("DEFINITION", &["TABULAR"]),
            one_of("VALUE", &["RELATIVE"]),
            left("SMOOTH"),
            used("INPUT"),
        ],
        "`amplitude`",
    ),
    of_model("SURFACE INTERACTION", Reader::surface_interaction, &[used("NAME")], "`law` of contacts"),
    of_model(
        "SURFACE BEHAVIOR",
        Reader::surface_behavior,
        &[
            one_of("PRESSURE-OVERCLOSURE", &["HARD", "LINEAR"]),
            used("PENALTY"),
            left("AUGMENTED LAGRANGE"),
            left("DIRECT"),
            refused("NO SEPARATION", "surfaces part where nothing presses them; leave it out"),
        ],
        "`penalty`; hard contact has the computed one",
    ),
    Keyword {
        name: "FRICTION",
        place: Where::Model,
        treated: Treated::Read(Reader::friction),
        parameters: &[
            used("ROUGH"),
            used("TAUMAX"),
            used("EXPONENTIAL DECAY"),
            left("SLIP TOLERANCE"),
            left("ELASTIC SLIP"),
            left("LAGRANGE"),
            refused("ANISOTROPIC", "give one coefficient"),
            refused("USER", BY_HAND),
            refused("DEPENDENCIES", "give one coefficient"),
        ],
        becomes: "`coulomb`, `sticking`, `orowan`, `velocity_dependent`; without it `frictionless`",
    },
    late(
        "CONTACT PAIR",
        Reader::contact_pair,
        &[
            used("INTERACTION"),
            one_of("TYPE", &["SURFACE TO SURFACE", "NODE TO SURFACE", "MORTAR", "LINMORTAR", "PGLINMORTAR"]),
            used("ADJUST"),
            noted("SMALL SLIDING", "sliding is finite: partners are found anew as surfaces move"),
            noted("HCRIT", "no depth has to be given"),
            noted("EXTENSION ZONE", "a surface ends where it ends"),
            left("SMOOTH"),
            left("SUPPLEMENTARY CONSTRAINTS"),
            left("MECHANICAL CONSTRAINT"),
            left("NO THICKNESS"),
            left("CPSET"),
            left("GEOMETRIC CORRECTION"),
            refused("TIED", "mesh the parts as one"),
        ],
        "`contact`",
    ),
    late("EQUATION", Reader::equation, &[used("INPUT")], "`equation`"),
    of_model("INITIAL CONDITIONS", Reader::initial_conditions, &[used("TYPE")], "temperature free of stress"),
    Keyword {
        name: "STEP",
        place: Where::Anywhere,
        treated: Treated::Read(Reader::step),
        parameters: &[
            used("NAME"),
            used("NLGEOM"),
            one_of("AMPLITUDE", &["RAMP", "STEP"]),
            left("INC"),
            left("INCF"),
            left("UNSYMM"),
            left("EXTRAPOLATION"),
            left("CONVERT SDI"),
            left("SOLVER"),
            refused("PERTURBATION", STATIC_ONLY),
        ],
        becomes: "`[[step]]`; without NLGEOM `strain = \"small\"`",
    },
    of_step(
        "STATIC",
        Reader::static_step,
        &[
            used("DIRECT"),
            left("SOLVER"),
            refused("RIKS", "lead the loaded nodes by *BOUNDARY in place of a load"),
            noted(
                "STABILIZE",
                "nothing is damped: what a step cannot reach by equilibrium alone is followed by relaxation",
            ),
            left("ALLSDTOL"),
            left("FACTOR"),
            left("CONTINUE"),
            noted("TIME RESET", "times count from the beginning of each step anyhow"),
            refused("TOTAL TIME AT START", "the first step begins at time zero"),
            left("FULLY PLASTIC"),
        ],
        "`duration`, `increments`",
    ),
    Keyword {
        name: "BOUNDARY",
        place: Where::Anywhere,
        treated: Treated::Read(Reader::boundary),
        parameters: &[
            used("AMPLITUDE"),
            one_of("OP", &["MOD", "NEW"]),
            one_of("TYPE", &["DISPLACEMENT"]),
            refused("FIXED", "give the value that the nodes came to"),
            refused("USER", "give an *AMPLITUDE"),
            refused("SUBMODEL", "give the values"),
            left("LOAD CASE"),
            left("TIME DELAY"),
        ],
        becomes: "`displacement`; on reference nodes `motion` of a tool",
    },
    of_step(
        "CLOAD",
        Reader::cload,
        &[
            COURSE[0].copied(),
            COURSE[1].copied(),
            refused("FOLLOWER", "lay a pressure on a surface by *DSLOAD"),
            refused("LOAD CASE", COMPLEX),
            refused("SECTOR", COMPLEX),
            refused("SUBMODEL", COMPLEX),
            refused("OMEGA0", COMPLEX),
        ],
        "`force`; on reference nodes `load` of a tool",
    ),
    of_step(
        "DLOAD",
        Reader::dload,
        &[COURSE[0].copied(), COURSE[1].copied(), refused("LOAD CASE", COMPLEX), refused("SECTOR", COMPLEX)],
        "`pressure` (P, P1 to P6), `body_force` (GRAV, BX, BY, BZ)",
    ),
    of_step(
        "DSLOAD",
        Reader::dsload,
        &[
            COURSE[0].copied(),
            COURSE[1].copied(),
            refused("FOLLOWER", "write P, which follows the surface"),
            refused("ORIENTATION", "write P"),
        ],
        "`pressure` (P)",
    ),
    of_step(
        "TEMPERATURE",
        Reader::temperature,
        &[
            COURSE[0].copied(),
            COURSE[1].copied(),
            refused("FILE", "give the values"),
            refused("BSTEP", "give the values"),
            refused("USER", "give the values"),
        ],
        "`temperature`, one for each body",
    ),
    Keyword {
        name: "END STEP",
        place: Where::Step,
        treated: Treated::Read(Reader::end_step),
        parameters: &[],
        becomes: "",
    },
    without_effect("PREPRINT", OUTPUT),
    without_effect("NODE PRINT", OUTPUT),
    without_effect("EL PRINT", OUTPUT),
    without_effect("CONTACT PRINT", OUTPUT),
    without_effect("NODE FILE", OUTPUT),
    without_effect("EL FILE", OUTPUT),
    without_effect("CONTACT FILE", OUTPUT),
    without_effect("SECTION PRINT", OUTPUT),
    without_effect("FACE PRINT", OUTPUT),
    without_effect("OUTPUT", OUTPUT),
    without_effect("NODE OUTPUT", OUTPUT),
    without_effect("ELEMENT OUTPUT", OUTPUT),
    without_effect("CONTACT OUTPUT", OUTPUT),
    without_effect("ENERGY OUTPUT", OUTPUT),
    without_effect("ENERGY PRINT", OUTPUT),
    without_effect("FILE FORMAT", OUTPUT),
    without_effect("MONITOR", OUTPUT),
    without_effect("PRINT", OUTPUT),
    without_effect("TIME POINTS", OUTPUT),
    without_effect("FILTER", OUTPUT),
    without_effect("RESTART", "checkpoints are written by themselves"),
    without_effect("CONTROLS", "the iterations have limits of their own: `solver`"),
    without_effect("CONTACT CONTROLS", "no contact needs controls"),
    without_effect("SECTION CONTROLS", "no cell has hourglass modes to control"),
    without_effect("HOURGLASS STIFFNESS", "no cell has hourglass modes to control"),
    without_effect("DAMPING", "nothing moves by inertia in a static step"),
    without_effect("CONDUCTIVITY", "no heat is conducted in a static step"),
    without_effect("SPECIFIC HEAT", "no heat is stored in a static step"),
    without_effect("GAP CONDUCTANCE", "no heat is conducted in a static step"),
    without_effect("PHYSICAL CONSTANTS", "no law reads them"),
    without_effect("ORIENTATION", "all laws are isotropic"),
    without_effect("MASS", "nothing moves by inertia in a static step"),
    without_effect("ROTARY INERTIA", "nothing moves by inertia in a static step"),
    no("TIE", CONSTRAINTS),
    no("MPC", CONSTRAINTS),
    no("COUPLING", CONSTRAINTS),
    no("KINEMATIC", CONSTRAINTS),
    no("DISTRIBUTING", CONSTRAINTS),
    no("KINEMATIC COUPLING", CONSTRAINTS),
    no("DISTRIBUTING COUPLING", CONSTRAINTS),
    no("EMBEDDED ELEMENT", CONSTRAINTS),
    no("CYCLIC SYMMETRY MODEL", CONSTRAINTS),
    no("PRE-TENSION SECTION", "shorten the bolt by a *TEMPERATURE of its body"),
    no("TRANSFORM", "lead the nodes along the axes, or write `along` into the deck of Asperity"),
    no("CHANGE FRICTION", "friction stays what it is over a run"),
    no("MODEL CHANGE", "contacts and elements stay over a run; lift the tool off by *BOUNDARY"),
    no("CHANGE MATERIAL", "materials stay what they are over a run"),
    no("CLEARANCE", "move the nodes, or give ADJUST to the *CONTACT PAIR"),
    no("CONTACT INTERFERENCE", "model the overlap in the mesh: it presses from the first increment on"),
    no("CONTACT", PAIRS_ONLY),
    no("CONTACT INCLUSIONS", PAIRS_ONLY),
    no("CONTACT EXCLUSIONS", PAIRS_ONLY),
    no("CONTACT PROPERTY ASSIGNMENT", PAIRS_ONLY),
    no("CONTACT DAMPING", "contact is not damped; leave it out"),
    no("COHESIVE BEHAVIOR", BY_HAND),
    no("SHELL SECTION", SOLIDS_ONLY),
    no("SHELL GENERAL SECTION", SOLIDS_ONLY),
    no("BEAM SECTION", SOLIDS_ONLY),
    no("BEAM GENERAL SECTION", SOLIDS_ONLY),
    no("MEMBRANE SECTION", SOLIDS_ONLY),
    no("COHESIVE SECTION", SOLIDS_ONLY),
    no("CONNECTOR SECTION", SOLIDS_ONLY),
    no("SPRING", "springs to the ground: `spring` of a step in the deck of Asperity"),
    no("DASHPOT", STATIC_ONLY),
    no("GAP", PAIRS_ONLY),
    no("NGEN", "list the nodes"),
    no("ELGEN", "list the elements"),
    no("NFILL", "list the nodes"),
    no("NCOPY", "list the nodes"),
    no("ELCOPY", "list the elements"),
    no("DEFORMATION PLASTICITY", "give *ELASTIC and *PLASTIC"),
    no("CYCLIC HARDENING", "give *PLASTIC a table"),
    no("CREEP", BY_HAND),
    no("VISCOELASTIC", BY_HAND),
    no("DRUCKER PRAGER", BY_HAND),
    no("DRUCKER PRAGER HARDENING", BY_HAND),
    no("MOHR COULOMB", BY_HAND),
    no("MOHR COULOMB HARDENING", BY_HAND),
    no("CAP PLASTICITY", BY_HAND),
    no("CLAY PLASTICITY", BY_HAND),
    no("POROUS METAL PLASTICITY", BY_HAND),
    no("HYPERFOAM", "fit OGDEN with its D1"),
    no("USER MATERIAL", BY_HAND),
    no("DEPVAR", BY_HAND),
    no("DAMAGE INITIATION", "materials do not fail but for the porous laws of Asperity"),
    no("DAMAGE EVOLUTION", "materials do not fail but for the porous laws of Asperity"),
    no("MULLINS EFFECT", "rubber does not soften"),
    no("DYNAMIC", STATIC_ONLY),
    no("VISCO", STATIC_ONLY),
    no("FREQUENCY", STATIC_ONLY),
    no("BUCKLE", STATIC_ONLY),
    no("MODAL DYNAMIC", STATIC_ONLY),
    no("STEADY STATE DYNAMICS", STATIC_ONLY),
    no("HEAT TRANSFER", STATIC_ONLY),
    no("COUPLED TEMPERATURE-DISPLACEMENT", STATIC_ONLY),
    no("UNCOUPLED TEMPERATURE-DISPLACEMENT", STATIC_ONLY),
    no("GREEN", STATIC_ONLY),
    no("SUBSTRUCTURE GENERATE", STATIC_ONLY),
    no("SUBMODEL", "give the values of the nodes by *BOUNDARY"),
    no("FILM", STATIC_ONLY),
    no("CFLUX", STATIC_ONLY),
    no("DFLUX", STATIC_ONLY),
    no("FIELD", "no law depends on fields"),
    no("INITIAL STRESS", BEGINNING),
];

impl Parameter {
    /// The same, for lists that are shared.
    const fn copied(&self) -> Self {
        let treated = match self.treated {
            Value::OneOf(words) => Value::OneOf(words),
            Value::Noted(what) => Value::Noted(what),
            Value::Refused(instead) => Value::Refused(instead),
            Value::Used => Value::Used,
            Value::Left => Value::Left,
        };
        Self { name: self.name, treated }
    }
}

/// The keyword of a name in capitals; blanks do not count.
pub fn named(name: &str) -> Option<&'static Keyword> {
    KEYWORDS.iter().find(|keyword| same(keyword.name, name))
}

/// Whether two names are the same but for blanks.
pub fn same(one: &str, other: &str) -> bool {
    let letters = |name: &'_ str| name.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    one == other || letters(one) == letters(other)
}

/// The manual's page, in Markdown.
pub fn manual() -> String {
    let mut text = String::from(
        "# Keywords of input decks\n\nPrinted by `asperity schema --keywords`. What is not in these tables is an error that names the \
         nearest keyword.\n\n## Read\n\n| keyword | becomes | parameters |\n|---|---|---|\n",
    );
    for keyword in KEYWORDS {
        if matches!(keyword.treated, Treated::Mesh(_) | Treated::Read(_) | Treated::Late(_) | Treated::Structure) {
            let parameters: Vec<String> = keyword.parameters.iter().filter_map(described).collect();
            let _ = writeln!(text, "| `*{}` | {} | {} |", keyword.name, keyword.becomes, parameters.join(", "));
        }
    }
    text += "\n## Left out, with a note\n\n| keyword | why |\n|---|---|\n";
    for keyword in KEYWORDS {
        if let Treated::Left(why) = keyword.treated {
            let _ = writeln!(text, "| `*{}` | {why} |", keyword.name);
        }
        for parameter in keyword.parameters {
            if let Value::Noted(what) = parameter.treated {
                let _ = writeln!(text, "| `*{}, {}` | {what} |", keyword.name, parameter.name);
            }
        }
    }
    text += "\n## Refused\n\n| keyword | what to do |\n|---|---|\n";
    for keyword in KEYWORDS {
        if let Treated::Refused(instead) = keyword.treated {
            let _ = writeln!(text, "| `*{}` | {instead} |", keyword.name);
        }
        for parameter in keyword.parameters {
            if let Value::Refused(instead) = parameter.treated {
                let _ = writeln!(text, "| `*{}, {}` | {instead} |", keyword.name, parameter.name);
            }
        }
    }
    text
}

/// A parameter that is used, with the words that it may have.
fn described(parameter: &Parameter) -> Option<String> {
    match parameter.treated {
        Value::Used => Some(parameter.name.to_string()),
        Value::OneOf(words) => {
            let words: Vec<&str> = words.iter().copied().filter(|word| !word.is_empty()).collect();
            Some(format!("{} ({})", parameter.name, words.join(", ")))
        }
        Value::Left | Value::Noted(_) | Value::Refused(_) => None,
    }
}

//! The figures of the certificate, each declared once: what it is called, how the readings of many increments become one,
//! and, where it has a limit, the limit's default, its words and what helps. To add one: its line in [`FIGURES`], and a
//! report that hands in readings under its name (`Frame::certify`). Keys of a deck, manual, summary, screen and notes follow.

/// A figure of the certificate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// Its name in `summary.json` and, where it has a limit, its key under `[limits]`.
    pub name: &'static str,
    /// What the screen and the notes call it.
    pub words: &'static str,
    /// How readings become one.
    pub fold: Fold,
    /// Beyond what a run is doubtful.
    pub limit: Option<Limit>,
}

/// How the readings of several increments become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fold {
    /// The largest is the worst.
    Largest,
    /// The least is the worst.
    Least,
    /// They are counted together.
    Sum,
    /// The largest that two increments in a row reach is the worst.
    Lasting,
}

/// The limit of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Its default, written as a deck would.
    pub default: &'static str,
    /// What the figure is, for the manual.
    pub about: &'static str,
    /// What helps where it is passed.
    pub remedy: &'static str,
}

const fn largest(name: &'static str, words: &'static str) -> Figure {
    Figure { name, words, fold: Fold::Largest, limit: None }
}

impl Figure {
    const fn folded(self, fold: Fold) -> Self {
        Self { fold, ..self }
    }
    const fn limited(self, default: &'static str, about: &'static str, remedy: &'static str) -> Self {
        Self { limit: Some(Limit { default, about, remedy }), ..self }
    }
    /// The figure of that name.
    pub fn named(name: &str) -> Option<&'static Figure> {
        FIGURES.iter().find(|figure| figure.name == name)
    }
}

/// All figures, in the order of the screen.
pub static FIGURES: &[Figure] = &[
    largest("max_penetration", "largest penetration"),
    largest("max_penetration_relative", "  over the cell's size").limited(
        "0.5",
        "Largest penetration at a contact point, over the length of the edge or face there.",
        "a stiffer `penalty`, `augmentation`, or smaller increments",
    ),
    largest("sampled_penetration", "  the same between the points").limited(
        "0.5",
        "Largest penetration found along rays between the contact points, over the length of the edge or face there.",
        "a finer surface, more points (`gauss`), or the finer side as the surface",
    ),
    largest("node_depth", "  depth of a single node").limited(
        "0.5",
        "Largest depth of a node of a contact's sides in what it is pressed against, less what overlapped before any motion, over the \
         length of the longest edge or face there. Found by the audit; the penetration of a contact field is a mean around a node.",
        "a stiffer `penalty`, a finer surface, or one that goes round the corner of the body",
    ),
    largest("interpenetration", "interpenetration that nothing explains").limited(
        "0.1",
        "Depth to which a body lies in another, in itself, in a tool or beyond the axis, beyond what contacts report, what curved \
         sides explain and what overlapped between two sides of a contact before any motion, over the size of the cell.",
        "a finer surface, one that goes round the corner of the body, a stiffer `penalty`, or a contact where none is declared",
    ),
    largest("pressure_oscillation", "jumps of the pressure in cells").limited(
        "3.0",
        "Root mean square distance of the pressure at the points of a body from the mean over the nodes of their cell, over that of \
         von Mises' stress: cells that cannot keep their volume and deform lock.",
        "formulation = \"f-bar\", or cells of second degree with integration = \"reduced\"",
    ),
    largest("nodal_penetration", "  weighted, at nodes"),
    largest("penalty_energy", "energy that penetration takes up").limited(
        "0.05",
        "Work of the pressure on the penetration of a contact, over the energy that the bodies take up.",
        "a stiffer `penalty`, or `augmentation`: the contact gives way in place of the bodies, as where a thin one is squeezed",
    ),
    largest("equilibrium_error", "equilibrium error").limited(
        "1e-3",
        "Unbalanced forces of the free nodes, summed, over the forces in play.",
        "a smaller `solver.tolerance`",
    ),
    largest("imbalance", "forces of the two sides differ by").limited(
        "0.05",
        "What the forces on the two sides of a contact of two passes leave over, relative to the largest force of the contact.",
        "with two passes each side answers for itself, and action equals reaction only as far as the meshes agree: finer \
         meshes bring them together, passes = \"one\" makes them equal",
    ),
    largest("moment_imbalance", "moments of the two sides differ by").limited(
        "0.05",
        "Moment that the forces on the two sides of a contact leave over, relative to that of all its forces at the ends of its surface.",
        "less penetration, finer meshes, or with two passes passes = \"one\"",
    ),
    largest("reaction_balance", "reactions and loads differ by").limited(
        "0.05",
        "What the forces on all supports and tools and all loads leave over, over the larger sum of both. Not read in models with springs.",
        "where the two sides of a contact bear different forces, passes = \"one\" or matching meshes",
    ),
    largest("energy_balance", "missing energy").limited(
        "0.2",
        "Work of supports and loads that is neither stored nor dissipated nor left over by rate laws, over the largest energy.",
        "smaller increments; the figure falls with them, and where a load acts at once with an `amplitude` that leads it in; what a bond or a \
         shape sets free as it lets go stays missing",
    ),
    largest("hypoelastic_residue", "work left over by rate laws"),
    largest("coulomb_violation", "excess over friction limit"),
    largest("friction_deviation", "friction differs from its law by").limited(
        "0.075",
        "Shear force of the slipping points of a contact on the target's normals, less what the law allows there, relative to \
         the shear force of the contact, or to half of what it would bear if all of it slipped; without friction the shear force relative to the \
         normal force.",
        "a finer surface, the flat side as `surface` with roles = \"given\", beside an edge on which a body stands the side beyond that in its \
         group too (`with`), or form = \"field\" where it is another: forces between bodies follow the normals of the surface, which are not \
         those of the target at an edge that is tilted",
    ),
    largest("closed_points", "closed points beside one another, at most"),
    largest("least_dissipation", "least dissipation").folded(Fold::Least),
    largest("facet_ratio", "pressure that facets stand for").limited(
        "1.0",
        "Pressure that the corners of curved faces of bodies are worth at points (`form = \"paper\"`), relative to the pressure that is carried.",
        "a finer mesh, edges of second degree, matching nodes, or a softer `penalty`: above one the pressure of points may be \
         anything; or form = \"field\", which takes facets for the surface that they stand for",
    ),
    largest("coarseness", "faces over what presses them").limited(
        "3.0",
        "Area of the faces around the nodes of a contact that bear, over the area on which they lie over a rigid tool in space, as a mean over \
         the force: a face cannot give way under a part of it alone.",
        "a finer surface where the tool touches: the force of a tool narrower than a few faces is too large",
    ),
    largest("mismatch", "mean pressures of the sides differ by"),
    largest("rejected_false_contacts", "false contacts refused").folded(Fold::Sum),
    largest("leap", "largest leap over the size").limited(
        "0.05",
        "Motion of an increment that moved more than 20 times as fast as the one before and far more than what is prescribed, over the \
         size of the model.",
        "prescribed displacements, control = \"arc-length\" or smaller increments: past a limit load it may be a remote equilibrium",
    ),
    largest("unstable", "negative eigenvalues of the stiffness").limited(
        "0",
        "Negative eigenvalues of the stiffness in equilibrium (of one that is not symmetric one for a negative determinant) in two increments \
         in a row: any small disturbance leaves such a state. Not asked where a path is followed by arc length, nor of models with contact.",
        "a small load or a shape along the mode (modes.pvd), so that it leaves to the side to which it is bent, with smaller increments; or control = \
         \"arc-length\"",
    ).folded(Fold::Lasting),
    largest("hourglass", "unresisted part of motion"),
    largest("small_strain", "gradient in small strain"),
];

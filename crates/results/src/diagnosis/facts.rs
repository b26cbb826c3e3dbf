//! What is known of a model before it runs.

/// A model, as far as a diagnosis asks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Facts {
    /// Size of the mesh, a length.
    pub size: f64,
    /// Its bodies.
    pub bodies: Vec<BodyFacts>,
    /// Its contacts.
    pub contacts: Vec<ContactFacts>,
    /// Its tools.
    pub tools: Vec<ToolFacts>,
    /// Its steps.
    pub steps: Vec<StepFacts>,
    /// Largest unbalanced force of a converged increment over the forces in play.
    pub tolerance: f64,
    /// Most iterations of an attempt.
    pub iterations: usize,
    /// Parts of the procedure that are switched off, by their keys.
    pub switched_off: Vec<&'static str>,
    /// What the mesh says of faces and nodes that lie on one another and are not joined, in words.
    pub seams: Vec<String>,
    /// The unit of length, where the deck names one.
    pub length_unit: Option<String>,
}

/// A body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BodyFacts {
    /// Its name.
    pub name: String,
    /// Its material.
    pub material: String,
    /// The word of its law, and the law's numbers by their keys.
    pub law: (&'static str, Vec<(&'static str, f64)>),
    /// Whether it has stresses before the first increment.
    pub prestressed: bool,
    /// A step that moves every node of it, as its group.
    pub driven_whole: Option<String>,
    /// Size, a length.
    pub size: f64,
    /// Length of its smallest cell.
    pub cell: f64,
    /// Young's modulus of the undeformed solid.
    pub young: f64,
    /// Bulk modulus over shear modulus.
    pub bulk_ratio: f64,
    /// Stress at first yield.
    pub yield_stress: Option<f64>,
    /// Largest stress that it bears however it is strained, where it hardens no further.
    pub strength: Option<f64>,
    /// Mass of a unit of volume.
    pub density: Option<f64>,
    /// Whether its cells lock when the volume is kept: of first degree, in full integration, without F-bar.
    pub locks: bool,
    /// Whether its cells have motions that meet no stiffness.
    pub hourglass: bool,
    /// Whether strain is small.
    pub small_strain: bool,
    /// Part of the distance of two opposite ends that prescribed motions leave, the least over the steps; one where they
    /// leave it to itself.
    pub left: f64,
    /// Axes along which no support, spring or equation acts on any of its nodes: "x".
    pub unheld: Vec<&'static str>,
    /// Whether any of its nodes is held, moved, or on a spring in any step.
    pub held: bool,
}

/// A contact.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactFacts {
    /// Its name.
    pub name: String,
    /// Bodies of its surface and of its target.
    pub bodies: Vec<String>,
    /// The tool that its target is.
    pub tool: Option<String>,
    /// Contact points, and how many of them see the target before any motion.
    pub points: usize,
    /// How many see it.
    pub seeing: usize,
    /// Nearest distance, negative for a penetration; none where nothing is seen.
    pub gap: Option<f64>,
    /// Part of the nodes of the surface's bodies that lie in the material of the tool before any motion.
    pub inside: f64,
    /// Whether the surface may touch itself, which it need not.
    pub itself: bool,
    /// Distance from the surface to the target, whichever way they face.
    pub distance: f64,
    /// Length of an edge of the surface.
    pub edge: f64,
    /// The penalty that the deck gives over the one that is computed.
    pub penalty: Option<f64>,
    /// Coefficient of friction, where there is one.
    pub friction: Option<f64>,
    /// Where weight is all that loads the first step: its part along the surface over that across it.
    pub slope: Option<f64>,
}

/// A tool.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ToolFacts {
    /// Its name.
    pub name: String,
    /// Size, a length.
    pub size: f64,
    /// Whether all its unknowns are prescribed in every step.
    pub driven: bool,
}

/// A load.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Load {
    /// Its path in the deck: "pressure.block.top".
    pub name: String,
    /// The bodies that it acts on.
    pub bodies: Vec<String>,
    /// Stress that it amounts to in the section that it acts on, roughly.
    pub stress: f64,
}

/// A step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepFacts {
    /// Its name.
    pub name: String,
    /// Largest displacement of a support over the step, a length.
    pub moved: f64,
    /// Largest motion of a tool over the step, a length.
    pub driven: f64,
    /// Loads that grow in it.
    pub loads: Vec<Load>,
    /// Its gravity.
    pub gravity: Option<f64>,
    /// Whether it prescribes motions and none of them differs from where the steps before led.
    pub repeats: bool,
    /// Whether it follows a path by arc length.
    pub follows: bool,
    /// First increment as a part of the step.
    pub first: f64,
    /// Largest and smallest increment as parts of the step.
    pub largest: f64,
    /// The smallest.
    pub smallest: f64,
    /// The most that it may take.
    pub most: usize,
}

impl Facts {
    /// The body of a name.
    pub fn body(&self, name: &str) -> Option<&BodyFacts> {
        self.bodies.iter().find(|body| body.name == name)
    }
    /// Bodies that a text names.
    pub fn bodies_in<'a>(&'a self, text: &'a str) -> impl Iterator<Item = &'a BodyFacts> {
        self.bodies.iter().filter(move |body| text.contains(&format!("body '{}'", body.name)))
    }
}

impl BodyFacts {
    /// A number of its law by its key.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.law.1.iter().find(|(name, _)| *name == key).map(|(_, value)| *value)
    }
}

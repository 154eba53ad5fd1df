//! The plan in words: what will be done and why, what is skipped and why.

use super::super::layout::Layout;
use super::super::request::columns;
use super::quiet::{METHOD, Quiet};
use super::turning::PARTS;
use super::{AS_KNOWN, Groups, Plan, TooLong};
use crate::forces::term::Coupling;
use crate::ode::Scheme;
use crate::ode::transformation::Transformation;
use crate::words::number;
use core::fmt;

/// A line of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// What it is about.
    pub what: String,
    /// What will be done.
    pub decision: String,
    /// Why.
    pub reason: String,
}

/// A tolerance to be read: without what dividing it has left in the last digits.
fn tolerance(rtol: f64) -> String {
    let told = format!("{rtol:.5e}");
    let (digits, power) = told.split_once('e').unwrap_or((&told, "0"));
    format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
}

impl Plan {
    /// The plan, line by line.
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Vec::new();
        let mut row = |what: &str, decision: String, reason: String| {
            rows.push(Row { what: what.to_owned(), decision, reason });
        };
        let (decision, reason) = self.describe_solution();
        row("solution", decision, reason);
        if let Some((decision, reason)) = self.describe_turning() {
            row("orientations", decision, reason);
        }
        if self.sets_of_forces > 1 {
            let decision = match self.kinds.iter().max() {
                Some(&last) if last > 0 => format!("{} of {} kinds", self.sets_of_forces, last + 1),
                _ => self.sets_of_forces.to_string(),
            };
            let why = "copies have parameters of their own, each in its lane; where more than numbers differs they are \
                       planned and run apart, the first as told here";
            row("sets of forces", decision, why.to_owned());
        }
        if self.solutions.integrates() {
            let steps = match (self.dt, self.transformed, self.tolerance) {
                (_, _, Some(rtol)) => {
                    format!(
                        "{PARTS} equal parts, each in steps that are halved until it stays the same to {}",
                        tolerance(rtol)
                    )
                }
                (Some(dt), ..) => format!("fixed step {dt}"),
                (None, Some((by, dt)), _) => {
                    format!("steps equal in the time of {}, {dt} at the start", by.name())
                }
                (None, None, _) => "steps chosen by the error estimate".to_owned(),
            };
            row("method", self.method.name.to_owned(), format!("order {}, {steps}", self.method.order));
            if let Some(step) = self.longest_untold {
                let why = "what an ExpressionForce does between the stages of a step is not felt: give max_step where it \
                           lasts for less";
                row("longest step", number(step), why.to_owned());
            }
            if self.known.as_ref().is_some_and(|known| !known.integrates()) {
                let why =
                    "the motion has a closed form; events are looked for on steps, which are to be as exact";
                row("relative tolerance", format!("at most {AS_KNOWN:e}"), why.to_owned());
            } else if let Some(rtol) = self.held_to {
                let why = "errors of single steps add up over many turns; name the method for steps held to rtol itself";
                row("relative tolerance", tolerance(rtol), why.to_owned());
            }
            if let Some((by, _)) = self.transformed {
                let told = match by {
                    Transformation::PotentialEnergy => {
                        "steps go as one over the potential energy: symplectic"
                    }
                    Transformation::Distance => {
                        "steps go as one over the sum of inverse distances: reversible"
                    }
                };
                row("time transformation", by.name().to_owned(), told.to_owned());
            }
            if let Some(Quiet { periods, dt }) = self.quiet {
                let why = format!(
                    "auto stays with steps that follow an encounter, whenever one comes; where none does, {METHOD} with \
                     dt={} is more exact in less time: scene.advise(t, accuracy=...) tries it",
                    number(dt)
                );
                row("long span", format!("{periods:.0} of the shortest period"), why);
            }
            if let Some(turn @ TooLong { body, steps, fewest, at_pericenter, .. }) = &self.too_long {
                let tight = if *at_pericenter { ", as tight as at its pericenter" } else { "" };
                let why = format!("the method tells nothing of an orbit with fewer than {fewest}");
                row(
                    "step too long",
                    format!("{steps:.2} in a turn of body {body} {}{tight}", turn.place()),
                    why,
                );
            }
            if self.from > 0 {
                let why = "the scene ended a run with this method and step: its bits are those of one run";
                row("start", format!("goes on from node {}", self.from), why.to_owned());
            }
            row(
                "force evaluations per step",
                self.method.stages.to_string(),
                "the method's stages".to_owned(),
            );
            if self.groups != Groups::Single {
                row("pairs per evaluation", self.pairs_per_evaluation().to_string(), self.describe_pairs());
            }
            let reason = match (self.layout, &self.groups) {
                (Layout::Packed, _) => "one system at a time",
                (Layout::Batched, Groups::Listed(_)) => "groups of coupled bodies, each with its own steps",
                (Layout::Batched, Groups::All) if self.copies == 1 => {
                    "one small system, in the first of eight lanes"
                }
                (Layout::Batched, Groups::All) => "small systems, each with its own steps",
                (Layout::Batched, Groups::Single) => "they do not interact: each has its own steps",
            };
            row("SIMD lanes", self.lanes().to_owned(), reason.to_owned());
            let (over, inside) = self.threads;
            let events = self.asked_events();
            if let (Some(rule), true) = (self.collisions, self.touching) {
                let why = "spheres are looked for on every step; all bodies are on the same steps, which begin anew there";
                row("collisions", rule.to_string(), why.to_owned());
            }
            if events > 0 {
                let where_found = if self.watches_apart() {
                    "on the steps of the bodies looked at, which are also integrated together where they are not coupled"
                } else {
                    "on the steps of the bodies looked at"
                };
                row("events", events.to_string(), where_found.to_owned());
            }
            row(
                "threads",
                over.max(inside).to_string(),
                if inside > 1 { "inside a force evaluation" } else { "over systems" }.to_owned(),
            );
            return rows;
        }
        if let (Some(rule), true) = (self.collisions, self.touching) {
            let why = "straight lines from one contact to the next, which is known: no steps";
            row("collisions", rule.to_string(), why.to_owned());
        }
        if self.threads.0 > 1 {
            row("threads", self.threads.0.to_string(), "over ensemble members and output times".to_owned());
        }
        rows
    }

    /// The events that were asked for, without that of spheres that touch.
    fn asked_events(&self) -> usize {
        self.events.len() - usize::from(self.touching)
    }

    fn describe_pairs(&self) -> String {
        let pairing = self.forces.iter().filter(|force| force.coupling() != Coupling::None).count();
        let bodies = match &self.groups {
            Groups::Listed(groups) => format!(
                "{} coupled bodies in groups of up to {}, {} by themselves",
                self.active.len(),
                groups.iter().map(|group| group.len()).max().unwrap_or_default(),
                self.passive.len()
            ),
            _ => format!("{} massive, {} massless bodies", self.active.len(), self.passive.len()),
        };
        if pairing > 1 { format!("{bodies}, {pairing} forces between them") } else { bodies }
    }

    /// What the SIMD lanes are.
    pub fn lanes(&self) -> &'static str {
        match (self.solutions.integrates(), self.layout, &self.groups) {
            (false, ..) => "none",
            (_, Layout::Packed, _) => "over bodies",
            (_, Layout::Batched, Groups::Single) => "over particles",
            (_, Layout::Batched, _) => "over copies",
        }
    }

    /// The method that runs; a closed form needs none.
    pub fn method_name(&self) -> &'static str {
        if self.solutions.integrates() { self.method.name } else { "closed form" }
    }

    /// What will not be done, and why.
    pub fn skipped(&self) -> Vec<(String, String)> {
        let mut skipped = Vec::new();
        let mut skip = |what: &str, why: String| skipped.push((what.to_owned(), why));
        if !self.solutions.integrates() {
            skip("stepping", "the motion has a closed form".to_owned());
        } else {
            if !self.solutions.integrates_all() {
                skip("stepping of some ensemble members", "their motion has a closed form".to_owned());
            }
            if self.alike > 0 {
                skip(
                    "uniform fields",
                    "they accelerate all bodies alike: the origin falls with them".to_owned(),
                );
            }
            if self.planar {
                skip("the z components", "z and v_z are zero and no force acts along z".to_owned());
            }
            if self.relative {
                let why = "the others tell where it is, as the center of mass moves uniformly";
                skip("steps of the first massive body", why.to_owned());
            }
            for (index, force) in self.forces.iter().enumerate() {
                match force.skipped() {
                    // Two forces that leave out the same are told once.
                    Some(told) if !self.forces[..index].iter().any(|other| other.skipped() == Some(told)) => {
                        skip(told.0, told.1.to_owned());
                    }
                    _ => {}
                }
            }
            if !self.passive.is_empty() && self.groups == Groups::All {
                let massless = self.passive.len() as u64;
                skip(
                    "pairs of massless bodies",
                    format!("{} pairs exert nothing", massless * (massless - 1) / 2),
                );
            }
            if self.groups == Groups::Single && self.particles > 1 {
                skip("pairs", "the particles do not interact".to_owned());
            }
            if self.method.adaptive() && self.outputs_between == 0 {
                skip("dense output", "no time before the end is asked for".to_owned());
            }
            if self.asked_events() == 0 {
                skip("event location", "no events are asked for".to_owned());
            }
        }
        match self.collisions {
            None if self.spheres => {
                skip("collisions", "not asked for: spheres pass through each other".to_owned())
            }
            Some(_) if !self.touching => skip("collisions", "no two bodies can touch".to_owned()),
            _ => {}
        }
        for column in columns() {
            if !self.record.iter().any(|name| name == column) {
                skip(&format!("the {column} column"), "not asked for".to_owned());
            }
        }
        skipped
    }

    fn describe_solution(&self) -> (String, String) {
        let integration = match self.method.scheme {
            Scheme::Embedded(_) | Scheme::Taylor(_) if self.touching => {
                "spheres that touch are looked for step by step"
            }
            Scheme::Embedded(_) | Scheme::Taylor(_) if !self.events.is_empty() => {
                "events are looked for step by step"
            }
            _ => "no closed form applies, or a method was named",
        };
        match self.solutions.counts()[..] {
            [(Some(form), _)] => (format!("closed form: {}", form.name), form.reason.to_owned()),
            [(None, _)] => ("integration".to_owned(), integration.to_owned()),
            ref several => {
                let (mut integrated, mut closed) = (0, Vec::new());
                for (solution, count) in several {
                    match solution {
                        None => integrated = *count,
                        Some(form) => closed.push(format!("{} ({count})", form.name)),
                    }
                }
                let closed = format!("closed form: {}", closed.join(", "));
                let decision = match integrated {
                    0 => closed,
                    count => format!("integration ({count}), {closed}"),
                };
                (decision, "ensemble members differ; of how many each is, in brackets".to_owned())
            }
        }
    }
}

impl fmt::Display for Plan {
    /// A table of what will be done, then a list of what is skipped.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.rows();
        let width = rows.iter().map(|row| row.what.len()).max().unwrap_or_default();
        for Row { what, decision, reason } in &rows {
            writeln!(formatter, "{what:width$}  {decision}  ({reason})")?;
        }
        let skipped: Vec<String> =
            self.skipped().into_iter().map(|(what, why)| format!("  {what}: {why}")).collect();
        write!(formatter, "skipped\n{}", skipped.join("\n"))
    }
}

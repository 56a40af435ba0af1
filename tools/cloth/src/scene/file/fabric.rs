//! The table `[fabric]`: density, and the resistance to stretch and bending.

use super::FabricTable;
use super::number::{Finite, Positive};
use super::on::{Place, SceneFault, put};
use super::word::BendLaw;
use crate::cloth::fabric::{Bending, Orthotropic, Stretch};
use crate::method::Method;
use crate::scene::Scene;
use crate::scene::frame::Frame;
use crate::system::bend::Buckling;

const PLACE: Place = Place::of("fabric", 0);

impl FabricTable {
    /// Changes the fabric of a scene whose method is chosen.
    pub(super) fn apply(&self, scene: &mut Scene, frame: &Frame, faults: &mut Vec<SceneFault>) {
        put(
            &mut scene.areal_density_kg_per_m2,
            self.density_kg_per_m2.as_deref(),
        );
        put(&mut scene.fabric.damping_s, self.damping_s.as_deref());
        put(&mut scene.fabric.bend_removal, self.unbend.as_deref());
        faults.extend(self.stretch(scene).err());
        faults.extend(self.bend(scene).err());
        faults.extend(self.weave(scene, frame).err());
    }

    /// What resists stretch along edges: a membrane, or springs of one stiffness.
    fn stretch(&self, scene: &mut Scene) -> Result<(), SceneFault> {
        let stretch = &mut scene.fabric.stretch;
        if let Some(&modulus_n_per_m) = self.modulus_n_per_m.as_deref() {
            *stretch = Stretch::Membrane { modulus_n_per_m };
        }
        if let Some(&stiffness_n_per_m) = self.stretch_n_per_m.as_deref() {
            *stretch = Stretch::Edges {
                stiffness_n_per_m,
                torn: self.copies.as_deref().copied().unwrap_or_default(),
            };
        }
        let clash = |key, message: &str| Err(PLACE.fault(key, "E-SCENE-CLASH", message));
        match self.stretch_n_per_m {
            Some(_) if self.modulus_n_per_m.is_some() => clash(
                "modulus_n_per_m",
                "`modulus_n_per_m` is of a membrane, and stretch_n_per_m of springs: give one of them",
            ),
            None if self.copies.is_some() => clash(
                "copies",
                "`copies` goes with stretch_n_per_m: each side of a torn membrane keeps what its faces give",
            ),
            _ => Ok(()),
        }
    }

    /// What resists bending: springs, or arcs that buckle.
    fn bend(&self, scene: &mut Scene) -> Result<(), SceneFault> {
        let buckles = self.bend_law.as_deref() == Some(&BendLaw::Buckling);
        let (foreign, other) = match buckles {
            true => (present!(self, bend_n_per_m), "spring"),
            false => (present!(self, rigidity_n_m, buckles_below), "buckling"),
        };
        if let Some((key, _)) = foreign.iter().find(|(_, is_given)| *is_given) {
            let message = format!("`{key}` goes with bend_law = \"{other}\"");
            return Err(PLACE.fault(key, "E-SCENE-CLASH", message));
        }
        if !buckles {
            if let Some(&stiffness_n_per_m) = self.bend_n_per_m.as_deref() {
                let spring = Bending::Spring { stiffness_n_per_m };
                scene.fabric.bend = (stiffness_n_per_m > 0.0).then_some(spring);
            }
            return Ok(());
        }
        let rigidity = self.rigidity_n_m.as_deref().copied();
        let rigidity_n_m = rigidity.ok_or_else(|| PLACE.missing("rigidity_n_m"))?;
        let law = Buckling::new(self.buckles_below.as_deref().copied().unwrap_or(0.95));
        let law = law.ok_or_else(|| {
            let message = "`buckles_below` is above 0.592 and under 1";
            PLACE.fault("buckles_below", "E-SCENE-RANGE", message)
        })?;
        scene.fabric.bend = Some(Bending::Buckling { rigidity_n_m, law });
        has_forces(scene, "bend_law", "know no arcs")
    }

    /// A fabric of triangles, which stands for a membrane or springs unless these are named as well.
    fn weave(&self, scene: &mut Scene, frame: &Frame) -> Result<(), SceneFault> {
        let keys = present!(self, warp_n_per_m, weft_n_per_m, shear_n_per_m, warp);
        let Some((key, _)) = keys.iter().find(|(_, is_given)| *is_given) else {
            return Ok(());
        };
        let modulus = |key, given: &Option<Positive>| {
            let modulus = given.as_deref().copied();
            modulus.ok_or_else(|| PLACE.missing(key))
        };
        scene.fabric.orthotropic = Some(Orthotropic {
            warp_n_per_m: modulus("warp_n_per_m", &self.warp_n_per_m)?,
            weft_n_per_m: modulus("weft_n_per_m", &self.weft_n_per_m)?,
            shear_n_per_m: self.shear_n_per_m.as_deref().copied().unwrap_or(0.0),
            warp: self
                .warp
                .as_ref()
                .map_or(frame.along.vector(), Finite::vector),
        });
        if self.stretch_n_per_m.is_none() && self.modulus_n_per_m.is_none() {
            scene.fabric.stretch = Stretch::Slack;
        }
        has_forces(scene, key, "have no triangles")
    }
}

/// Refuses methods that move springs, where a key asks for something else.
fn has_forces(scene: &Scene, key: &'static str, lack: &str) -> Result<(), SceneFault> {
    if matches!(scene.solver, Method::Pbd(_) | Method::Xpbd(_)) {
        let message = format!("pbd and xpbd move springs, and {lack}");
        let help = "add method = \"implicit\" to [solver]; verlet and provot do as well";
        return Err(PLACE.fault(key, "E-SCENE-CLASH", message).help(help));
    }
    Ok(())
}

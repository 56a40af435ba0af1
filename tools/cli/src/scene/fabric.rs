//! What `[fabric]` says: its weight, and what resists stretch and bending.

use tearmesh_cloth::Method;
use tearmesh_cloth::scene::{Frame, Scene};
use tearmesh_cloth::{Bending, Buckling, Copies, Unbend, Weave};

use super::file::{SceneFile, Table};
use crate::say::Fault;

impl SceneFile {
    /// Changes the fabric of a scene whose method is chosen.
    pub(super) fn fabric(&self, scene: &mut Scene, frame: &Frame, faults: &mut Vec<Fault>) {
        let Some(table) = self.first("fabric") else {
            return;
        };
        let fabric = &mut scene.fabric;
        if let Some(density) = table.number("density_kg_per_m2") {
            scene.areal_density_kg_per_m2 = density;
        }
        if let Some(stretch) = table.number("stretch_n_per_m") {
            fabric.stretch_n_per_m = stretch;
        }
        match table.word("copies") {
            Some("whole") => fabric.copies = Copies::Whole,
            Some(_) => fabric.copies = Copies::Halved,
            None => {}
        }
        match table.word("unbend") {
            Some("vertex") => fabric.unbend = Unbend::Vertex,
            Some(_) => fabric.unbend = Unbend::Seam,
            None => {}
        }
        for done in [self.bend(table, scene), self.weave(table, scene, frame)] {
            faults.extend(done.err().map(|fault| *fault));
        }
    }

    /// What resists bending: springs, or arcs that buckle.
    fn bend(&self, table: &Table, scene: &mut Scene) -> Result<(), Box<Fault>> {
        let is_arc = table.word("bend_law") == Some("buckling");
        let foreign: &[&'static str] = if is_arc {
            &["bend_n_per_m"]
        } else {
            &["flexural_n_m2", "buckles_below"]
        };
        if let Some(&key) = table.those_of(foreign).first() {
            let law = if is_arc { "spring" } else { "buckling" };
            let message = format!("`{key}` goes with bend_law = \"{law}\"");
            return Err(self.fault(table, key, "E-SCENE-CLASH", message));
        }
        if !is_arc {
            if let Some(stiffness_n_per_m) = table.number("bend_n_per_m") {
                let spring = Bending::Spring { stiffness_n_per_m };
                scene.fabric.bend = (stiffness_n_per_m > 0.0).then_some(spring);
            }
            return Ok(());
        }
        let flexural_n_m2 = table.number("flexural_n_m2");
        let flexural_n_m2 =
            flexural_n_m2.ok_or_else(|| self.missing(table, "fabric", "flexural_n_m2"))?;
        let law = Buckling::new(table.number("buckles_below").unwrap_or(0.95));
        let law = law.ok_or_else(|| {
            let message = "`buckles_below` is above 0.592 and under 1".to_owned();
            self.fault(table, "buckles_below", "E-SCENE-RANGE", message)
        })?;
        scene.fabric.bend = Some(Bending::Buckling { flexural_n_m2, law });
        self.has_forces(scene, table, "bend_law", "know no arcs")
    }

    /// A fabric of triangles, which stands for springs on edges unless these are named as well.
    fn weave(&self, table: &Table, scene: &mut Scene, frame: &Frame) -> Result<(), Box<Fault>> {
        let keys = ["warp_n_per_m", "weft_n_per_m", "shear_n_per_m", "warp"];
        let Some(&key) = table.those_of(&keys).first() else {
            return Ok(());
        };
        let required = |key: &'static str| {
            let modulus = table.number(key);
            modulus.ok_or_else(|| self.missing(table, "fabric", key))
        };
        scene.fabric.weave = Some(Weave {
            warp_n_per_m: required(keys[0])?,
            weft_n_per_m: required(keys[1])?,
            shear_n_per_m: table.number(keys[2]).unwrap_or(0.0),
            warp: table
                .vector(keys[3])
                .unwrap_or_else(|| frame.along.vector()),
        });
        scene.fabric.stretch_n_per_m = table.number("stretch_n_per_m").unwrap_or(0.0);
        self.has_forces(scene, table, key, "have no triangles")
    }

    /// Refuses methods that move springs, where a key asks for something else.
    fn has_forces(
        &self,
        scene: &Scene,
        table: &Table,
        key: &str,
        lack: &str,
    ) -> Result<(), Box<Fault>> {
        if matches!(scene.solver, Method::Pbd(_) | Method::Xpbd(_)) {
            let message = format!("pbd and xpbd move springs, and {lack}");
            let fault = self.fault(table, key, "E-SCENE-CLASH", message);
            let help = "add method = \"implicit\" to [solver]; verlet and provot do as well";
            return Err(Box::new(fault.help(help.to_owned())));
        }
        Ok(())
    }
}

//! The keys of `[fabric]`: density, and the resistance to stretch and bending.

use tearmesh_cloth::Method;
use tearmesh_cloth::scene::{Frame, Scene};
use tearmesh_cloth::{Bending, Buckling, Orthotropic, Stretch};

use super::apply::vector;
use super::kinds::set;
use super::read::{SceneFile, Table};
use crate::say::Fault;

impl SceneFile {
    /// Changes the fabric of a scene whose method is chosen.
    pub(super) fn fabric(&self, scene: &mut Scene, frame: &Frame, faults: &mut Vec<Fault>) {
        let Some(table) = self.table("fabric") else {
            return;
        };
        let fabric = &mut scene.fabric;
        let density = table.get("density_kg_per_m2");
        set(&mut scene.areal_density_kg_per_m2, density);
        set(&mut fabric.damping_s, table.get("damping_s"));
        set(&mut fabric.bend_removal, table.word("unbend"));
        faults.extend(self.stretch(table, scene).err());
        faults.extend(self.bend(table, scene).err());
        faults.extend(self.weave(table, scene, frame).err());
    }

    /// What resists stretch along edges: a membrane, or springs of one stiffness.
    fn stretch(&self, table: &Table, scene: &mut Scene) -> Result<(), Fault> {
        let stretch = &mut scene.fabric.stretch;
        let membrane = |modulus_n_per_m| Stretch::Membrane { modulus_n_per_m };
        set(stretch, table.get("modulus_n_per_m").map(membrane));
        if let Some(stiffness_n_per_m) = table.get("stretch_n_per_m") {
            *stretch = Stretch::Edges {
                stiffness_n_per_m,
                torn: table.word("copies").unwrap_or_default(),
            };
        }
        let has = |key| table.has(key);
        let clash = |key, message: &str| Err(self.fault(table, key, "E-SCENE-CLASH", message));
        match has("stretch_n_per_m") {
            true if has("modulus_n_per_m") => clash(
                "modulus_n_per_m",
                "`modulus_n_per_m` is of a membrane, and stretch_n_per_m of springs: give one of them",
            ),
            false if has("copies") => clash(
                "copies",
                "`copies` goes with stretch_n_per_m: each side of a torn membrane keeps what its faces give",
            ),
            _ => Ok(()),
        }
    }

    /// What resists bending: springs, or arcs that buckle.
    fn bend(&self, table: &Table, scene: &mut Scene) -> Result<(), Fault> {
        let law: Option<String> = table.get("bend_law");
        let buckles = law.as_deref() == Some("buckling");
        let (foreign, other): (&[&str], _) = match buckles {
            true => (&["bend_n_per_m"], "spring"),
            false => (&["rigidity_n_m", "buckles_below"], "buckling"),
        };
        if let Some(&key) = table.those_of(foreign).first() {
            let message = format!("`{key}` goes with bend_law = \"{other}\"");
            return Err(self.fault(table, key, "E-SCENE-CLASH", message));
        }
        if !buckles {
            if let Some(stiffness_n_per_m) = table.get("bend_n_per_m") {
                let spring = Bending::Spring { stiffness_n_per_m };
                scene.fabric.bend = (stiffness_n_per_m > 0.0).then_some(spring);
            }
            return Ok(());
        }
        let rigidity_n_m = table.get("rigidity_n_m");
        let rigidity_n_m = rigidity_n_m.ok_or_else(|| self.missing(table, "rigidity_n_m"))?;
        let law = Buckling::new(table.get("buckles_below").unwrap_or(0.95));
        let law = law.ok_or_else(|| {
            let message = "`buckles_below` is above 0.592 and under 1";
            self.fault(table, "buckles_below", "E-SCENE-RANGE", message)
        })?;
        scene.fabric.bend = Some(Bending::Buckling { rigidity_n_m, law });
        self.has_forces(scene, table, "bend_law", "know no arcs")
    }

    /// A fabric of triangles, which stands for a membrane or springs unless these are named as well.
    fn weave(&self, table: &Table, scene: &mut Scene, frame: &Frame) -> Result<(), Fault> {
        let keys = ["warp_n_per_m", "weft_n_per_m", "shear_n_per_m", "warp"];
        let Some(&key) = table.those_of(&keys).first() else {
            return Ok(());
        };
        let modulus = |key| table.get(key).ok_or_else(|| self.missing(table, key));
        scene.fabric.orthotropic = Some(Orthotropic {
            warp_n_per_m: modulus(keys[0])?,
            weft_n_per_m: modulus(keys[1])?,
            shear_n_per_m: table.get("shear_n_per_m").unwrap_or(0.0),
            warp: vector(table, "warp").unwrap_or_else(|| frame.along.vector()),
        });
        if !table.has("stretch_n_per_m") && !table.has("modulus_n_per_m") {
            scene.fabric.stretch = Stretch::Slack;
        }
        self.has_forces(scene, table, key, "have no triangles")
    }

    /// Refuses methods that move springs, where a key asks for something else.
    fn has_forces(&self, scene: &Scene, table: &Table, key: &str, lack: &str) -> Result<(), Fault> {
        if matches!(scene.solver, Method::Pbd(_) | Method::Xpbd(_)) {
            let message = format!("pbd and xpbd move springs, and {lack}");
            let fault = self.fault(table, key, "E-SCENE-CLASH", message);
            let help = "add method = \"implicit\" to [solver]; verlet and provot do as well";
            return Err(fault.help(help));
        }
        Ok(())
    }
}

//! A scene file with everything that it names outside of itself, for a program that opens no files.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use tearmesh::VertexId;
use tearmesh::geometry::Point;

use super::SceneFile;
use super::on::{BodyMesh, SceneFault};
use crate::scene::Scene;
use crate::scene::frame::Frame;
use crate::system::load::ColliderShape;

/// A scene file for one mesh, as data: the page of `tearmesh play` has one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackedScene {
    /// The tables and keys of the scene file, in a format that the program reads, such as JSON.
    pub text: String,
    /// The bodies, by the numbers of their colliders from 0.
    pub bodies: BTreeMap<usize, BodyMesh>,
    /// The vertices that have another id than their number in the file says, with that id second.
    pub vertices: Vec<(VertexId, VertexId)>,
    /// The rest shape: see [`Scene::rest`].
    pub rest: Vec<Point>,
}

impl PackedScene {
    /// Packs the text of a scene file with what the [scene](SceneFile::on) that was made of it has from elsewhere.
    #[must_use]
    pub fn new(text: String, scene: &Scene, vertices: Vec<(VertexId, VertexId)>) -> PackedScene {
        let colliders = scene.colliders.iter().enumerate();
        let bodies = colliders.filter_map(|(number, collider)| match &collider.shape {
            ColliderShape::Body { body, .. } => {
                Some((number, (body.points().to_vec(), body.faces().to_vec())))
            }
            _ => None,
        });
        PackedScene {
            text,
            bodies: bodies.collect(),
            vertices,
            rest: scene.rest.clone(),
        }
    }

    /// Returns the scene for a mesh with this frame. `file` is the [text](PackedScene::text), read.
    ///
    /// # Errors
    ///
    /// Every [`SceneFault`], as from [`SceneFile::on`].
    pub fn on(&self, file: &SceneFile, frame: &Frame) -> Result<Scene, Vec<SceneFault>> {
        let body = |number, name: &str| {
            let body = self.bodies.get(&number).cloned();
            body.ok_or_else(|| format!("the body `{name}` was not packed"))
        };
        let mut scene = file.on(frame, None, &mut { body })?;
        let ids: BTreeMap<VertexId, VertexId> = self.vertices.iter().copied().collect();
        scene.rename_vertices(|vertex| *ids.get(&vertex).unwrap_or(&vertex));
        scene.rest.clone_from(&self.rest);
        Ok(scene)
    }
}

//! From a hit to the attributes of the surface there.
//!
//! NOTE to the loader engineer (remove when written): the CPU backend is coded against exactly this API:
//! `Surfaces::new(scene: Arc<Scene>) -> Surfaces` (owns the Arc, no lifetime, Debug, Sync),
//! `surfaces.surface_at(&Hit, width: f32) -> SurfacePoint` with `.facing(ray_direction: Vec3) -> SurfacePoint`,
//! `surfaces.diffuse_at(&Hit, width: f32) -> DiffusePoint { position, geometric_normal, albedo, emission }`,
//! `surfaces.is_opaque(mesh: u32) -> bool`, `surfaces.accepts(instance: u32, triangle: u32, u: f32, v: f32, seed: u32) -> bool`.
//! SurfacePoint fields: position, geometric_normal, smooth_normal, shading_normal, albedo, emission, material: u32, unlit: bool.
// STUB until then: replace all of it.
#![allow(missing_docs)]
use std::sync::Arc; use glam::Vec3; use crate::Scene; use ambray_core::trace::Hit;
#[derive(Debug)] pub struct Surfaces{scene:Arc<Scene>}
#[derive(Debug,Clone,Copy)] pub struct SurfacePoint{pub position:Vec3,pub geometric_normal:Vec3,pub smooth_normal:Vec3,pub shading_normal:Vec3,pub albedo:Vec3,pub emission:Vec3,pub material:u32,pub unlit:bool}
#[derive(Debug,Clone,Copy)] pub struct DiffusePoint{pub position:Vec3,pub geometric_normal:Vec3,pub albedo:Vec3,pub emission:Vec3}
impl Surfaces{ pub fn new(scene:Arc<Scene>)->Self{Self{scene}} 
 pub fn is_opaque(&self,_:u32)->bool{true} pub fn accepts(&self,_:u32,_:u32,_:f32,_:f32,_:u32)->bool{true}
 pub fn diffuse_at(&self,h:&Hit,_:f32)->DiffusePoint{ let i=&self.scene.instances[h.instance as usize]; let m=&self.scene.meshes[i.mesh as usize]; let [a,b,c]=m.corners(h.triangle).map(|p|i.world_from_object.transform_point3(p)); let n=(b-a).cross(c-a).normalize();
   DiffusePoint{position:a*(1.0-h.u-h.v)+b*h.u+c*h.v,geometric_normal:n,albedo:self.scene.materials[m.material as usize].base_color.truncate(),emission:Vec3::ZERO} }
 pub fn surface_at(&self,h:&Hit,w:f32)->SurfacePoint{let d=self.diffuse_at(h,w); SurfacePoint{position:d.position,geometric_normal:d.geometric_normal,smooth_normal:d.geometric_normal,shading_normal:d.geometric_normal,albedo:d.albedo,emission:d.emission,material:self.scene.meshes[self.scene.instances[h.instance as usize].mesh as usize].material,unlit:false}} }
impl SurfacePoint{ pub fn facing(self,d:Vec3)->Self{ if self.geometric_normal.dot(d)>0.0 {Self{geometric_normal:-self.geometric_normal,smooth_normal:-self.smooth_normal,shading_normal:-self.shading_normal,..self}} else {self} } }

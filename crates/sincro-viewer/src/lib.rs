//! A door: browsers look at a scene or a run, and may press play.
//!
//! [`film`] gathers what there is to see of finished runs; [`embed`] puts it into a page that opens without a server; [`live`] runs a scene and
//! [`server`] shows either to browsers. The page itself stands in `page/` (TypeScript, three.js, uPlot), and its bundle is committed, so that building this crate needs no Node.

pub mod embed;
mod encoding;
pub mod film;
pub mod live;
pub mod mcap;
pub mod picture;
mod save;
pub mod server;
mod vector;

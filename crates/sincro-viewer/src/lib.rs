//! Viewer adapter: live scenes and finished runs in the browser, in 3-D and with plots.
//!
//! [`replay`] gathers the data of finished runs; [`embed`] puts it into a page that opens without a server; [`live`]
//! runs a scene and [`server`] shows either to browsers. The page itself stands in `page/` (TypeScript, three.js,
//! uPlot), and its bundle is committed, so that building this crate needs no Node.

pub mod embed;
mod encoding;
pub mod live;
pub mod mcap;
pub mod picture;
pub mod replay;
mod save;
pub mod server;
mod vector;

//! The intermediate representation: structured control flow over scalar components, with every call inlined
//! and all vectors and structures scalarized.
//!
//! Values are in SSA form; cells are the scalarized variables. Control flow has four nodes: `If`, `Scope`,
//! `Loop`, and `Break`, which ends a scope for the pixels that reach it. `Break` expresses `break`,
//! `continue`, `return` and `discard`.

mod alias;
mod function;
mod operation;
mod profile;
mod schema;
mod site;

pub(crate) use self::alias::AliasGroups;
pub(crate) use self::function::{Axis, Block, Cell, Cells, Function, LoopId, Node, Scope};
pub use self::function::{NONE, Value, ValueDef};
pub(crate) use self::operation::for_each_operation;
pub use self::operation::{Kind, Operation};
pub(crate) use self::profile::{BasicBlock, ProfileSchema, cost};
pub use self::profile::{Origin, Part, PartId, PartKind};
pub use self::schema::{Call, CallId, Event, EventId, EventKind, Store, StoreId, TraceSchema};
pub use self::site::{Fault, Predicate, Site, SiteId};

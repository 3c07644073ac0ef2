//! Operations by name, with requests and figures as JSON: for modules of other languages, and for services.

use crate::accuracy::{self, demand_kept};
use crate::failure::{Failure, Result};
use crate::import::{ImportRequest, import};
use crate::optimise::OptimiseRequest;
use crate::watch::Watch;
use crate::{bevel_pair, check, compare, compliance, export, mesh, modes, recover, report, tca};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::PathBuf;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CheckRequest {
    file: PathBuf,
}

/// Does an operation, which is named as the command of the program is; what the command prints with `--json`.
///
/// # Errors
/// [`Failure`] of the operation, for a name that is none, and for a request that the operation does not know.
pub fn call(name: &str, request: Value, watch: &Watch<'_>) -> Result<Value> {
    match name {
        "accuracy" => {
            let found = accuracy::accuracy(&read(name, request)?, watch)?;
            demand_kept(&found)?;
            Ok(accuracy::figures(&found))
        }
        "bevel" => Ok(bevel_pair::design(&read(name, request)?, watch)?.figures),
        "check" => {
            let CheckRequest { file } = read(name, request)?;
            let found = check::check(&file)?;
            match &found.problem {
                Some(problem) => Err(Failure::work(problem)),
                None => Ok(found.figures(&file)),
            }
        }
        "compare" => Ok(compare::compare(&read(name, request)?)?.figures()),
        "compliance" => Ok(compliance::compliance(&read(name, request)?, watch)?.figures()),
        "export" => Ok(export::export(&read(name, request)?, watch)?.figures),
        "import" => {
            let request: ImportRequest = read(name, request)?;
            let found = import(&request, watch)?;
            match found.refusal(&request) {
                Some((_, failure)) => Err(failure),
                None => Ok(found.figures()),
            }
        }
        "mesh" => Ok(mesh::mesh(&read(name, request)?, watch)?.figures()),
        "modes" => Ok(modes::modes(&read(name, request)?, watch)?.figures()),
        "optimise" => {
            let of: OptimiseRequest = read(name, request)?;
            let found = of.optimise(watch)?;
            found.demand_ended()?;
            Ok(found.figures())
        }
        "recover" => Ok(recover::figures(&recover::recover(
            &read(name, request)?,
            watch,
        )?)),
        "report" => Ok(report::report(&read(name, request)?, watch)?.figures),
        "tca" => Ok(tca::tca(&read(name, request)?, watch)?.figures),
        other => Err(Failure::input(format!("there is no operation `{other}`"))),
    }
}

/// The request of an operation.
fn read<T: DeserializeOwned>(name: &str, request: Value) -> Result<T> {
    serde_json::from_value(request).map_err(|error| Failure::input(format!("{name}: {error}")))
}

//! Open Job Description, version 2023-09: a job template in JSON, which is YAML as well.

use super::FarmJob;
use serde_json::json;

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    if let Some(odd) = job.arguments("").find(|argument| argument.contains("{{")) {
        return Err(format!("{odd:?} contains \"{{{{\", which Open Job Description replaces"));
    }
    let arguments: Vec<String> = job.arguments("{{Task.Param.Part}}").collect();
    let template = json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": job.name,
        "steps": [{
            "name": "Parts",
            "parameterSpace": {
                "taskParameterDefinitions": [
                    {"name": "Part", "type": "INT", "range": format!("1-{}", job.parts)}
                ]
            },
            "script": {"actions": {"onRun": {"command": "dragonfly", "args": arguments}}}
        }]
    });
    let text = serde_json::to_string_pretty(&template).map_err(|error| error.to_string())?;
    Ok(text + "\n")
}

//! Open Job Description, version 2023-09: a job template in JSON, which is YAML as well.

use super::FarmJob;
use serde_json::{Value, json};

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    let last = job.last.as_deref().unwrap_or_default();
    if let Some(odd) = job.arguments("").chain(last.iter().cloned()).find(|argument| argument.contains("{{"))
    {
        return Err(format!("{odd:?} contains \"{{{{\", which Open Job Description replaces"));
    }
    let arguments: Vec<String> = job.arguments("{{Task.Param.Part}}").collect();
    let run =
        |arguments: &[String]| json!({"actions": {"onRun": {"command": "dragonfly", "args": arguments}}});
    let mut steps = vec![json!({
        "name": "Parts",
        "parameterSpace": {
            "taskParameterDefinitions": [
                {"name": "Part", "type": "INT", "range": job.numbers.range(":")}
            ]
        },
        "script": run(&arguments)
    })];
    if let Some(last) = &job.last {
        steps.push(json!({
            "name": "Join",
            "dependencies": [{"dependsOn": "Parts"}],
            "script": run(last)
        }));
    }
    let template = json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": job.name,
        "steps": Value::Array(steps)
    });
    let text = serde_json::to_string_pretty(&template).map_err(|error| error.to_string())?;
    Ok(text + "\n")
}

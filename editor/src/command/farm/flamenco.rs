//! Flamenco 3: a job type in JavaScript, with a task for each part.

use super::FarmJob;

/// Stands for the number of the part in a list of arguments until the job type is compiled.
const TOKEN: &str = "@PART@";

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    let arguments: Vec<String> = job.arguments(TOKEN).collect();
    let (last, first) = arguments.split_last().ok_or("a job without arguments")?;
    // JSON is JavaScript.
    let text = |value: serde_json::Value| value.to_string();
    let shard = last.replace(TOKEN, "");
    Ok(format!(
        r#"// Flamenco job type: copy this file to the folder "scripts" next to the manager.
const JOB_TYPE = {{
    label: {label},
    settings: [],
}};

function compileJob(job) {{
    for (let part = 1; part <= {parts}; part++) {{
        const task = author.Task("part " + part, "misc");
        const args = {arguments}.concat([part + {shard}]);
        task.addCommand(author.Command("exec", {{ exe: "dragonfly", args: args }}));
        job.addTask(task);
    }}
}}
"#,
        label = text(job.name.into()),
        parts = job.parts,
        arguments = text(first.into()),
        shard = text(shard.into()),
    ))
}

//! Flamenco 3: a job type in JavaScript, with a task for each part.

use super::{FarmJob, PART};

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    // JSON is JavaScript.
    let label = serde_json::Value::from(job.name).to_string();
    let numbers = job.numbers;
    let next = if numbers.step == 1 { "part++".to_owned() } else { format!("part += {}", numbers.step) };
    let (first, last, arguments) = (numbers.first, numbers.last(), list(&job.arguments)?);
    let (mut before, mut inside, mut after) = (String::new(), String::new(), String::new());
    if let Some(join) = &job.last {
        before = "    const parts = [];\n".to_owned();
        inside = "        parts.push(task);\n".to_owned();
        after = format!(
            r#"    const join = author.Task("join", "misc");
    join.addCommand(author.Command("exec", {{ exe: "dragonfly", args: {} }}));
    for (const task of parts) {{
        join.addDependency(task);
    }}
    job.addTask(join);
"#,
            list(join)?
        );
    }
    Ok(format!(
        r#"// Flamenco job type: copy this file to the folder "scripts" next to the manager.
const JOB_TYPE = {{
    label: {label},
    settings: [],
}};

function compileJob(job) {{
{before}    for (let part = {first}; part <= {last}; {next}) {{
        const task = author.Task("part " + part, "misc");
        const args = {arguments};
        task.addCommand(author.Command("exec", {{ exe: "dragonfly", args: args }}));
        job.addTask(task);
{inside}    }}
{after}}}
"#
    ))
}

/// Returns arguments as a list in JavaScript, in which `part` is the number of the part. Of a list that ends with it, only the end is computed.
fn list(arguments: &[String]) -> Result<String, String> {
    let (last, first) = arguments.split_last().ok_or("a job without arguments")?;
    if last.starts_with(PART) && !first.iter().any(|argument| argument.contains(PART)) {
        let first = serde_json::Value::from(first).to_string();
        return Ok(format!("{first}.concat([{}])", expression(last)));
    }
    let all: Vec<String> = arguments.iter().map(|argument| expression(argument)).collect();
    Ok(format!("[{}]", all.join(",")))
}

/// Returns an argument as an expression.
fn expression(argument: &str) -> String {
    let text = |text: &str| serde_json::Value::from(text).to_string();
    match argument.split_once(PART) {
        None => text(argument),
        Some(("", after)) => format!("part + {}", text(after)),
        Some((before, after)) => format!("{} + part + {}", text(before), text(after)),
    }
}

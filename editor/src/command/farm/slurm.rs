//! Slurm: a batch script of an array job. A task of a node that fails is run again. Where a command follows the parts, a script that submits both.

use super::FarmJob;

/// Number of a task of an array job.
const TASK: &str = "SLURM_ARRAY_TASK_ID";

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    let numbers = job.numbers;
    // The indices of tasks are small in most clusters, so that they count the parts.
    let (array, token) = match (numbers.first, numbers.step) {
        (1, 1) => (format!("1-{}", numbers.count), format!("\"${TASK}\"")),
        (first, step) => (format!("0-{}", numbers.count - 1), format!("\"$(({first} + {TASK} * {step}))\"")),
    };
    let (name, line) = (job.name, job.shell_line(&token));
    let Some(last) = job.last_shell_line() else {
        return Ok(format!(
            "#!/bin/sh\n#SBATCH --job-name={name}\n#SBATCH --array={array}\n#SBATCH --requeue\nexec {line}\n"
        ));
    };
    Ok(format!(
        r#"#!/bin/sh
# Submits two jobs: sh FILE
set -eu
parts=$(sbatch --parsable --job-name={name} --array={array} --requeue <<'END'
#!/bin/sh
exec {line}
END
)
sbatch --job-name={name}-join --dependency="afterok:${{parts%%;*}}" --requeue <<'END'
#!/bin/sh
exec {last}
END
"#
    ))
}

//! Slurm: a batch script of an array job. A task of a node that fails is run again.

use super::FarmJob;

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    Ok(format!(
        "#!/bin/sh\n#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --requeue\nexec {}\n",
        job.name,
        job.parts,
        job.shell_line("\"$SLURM_ARRAY_TASK_ID\"")
    ))
}

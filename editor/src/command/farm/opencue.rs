//! OpenCue: a job specification in its XML, with a frame for each part.

use super::FarmJob;

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    let command = job.shell_line("#IFRAME#");
    let escaped = command
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace('\'', "&apos;");
    let (name, parts) = (job.name, job.parts);
    Ok(format!(
        r#"<?xml version="1.0"?>
<!DOCTYPE spec PUBLIC "SPI Cue Specification Language" "http://localhost:8080/spcue/dtd/cjsl-1.15.dtd">
<spec>
  <facility>local</facility>
  <show>testing</show>
  <shot>testing</shot>
  <user>user</user>
  <job name="{name}">
    <paused>False</paused>
    <maxretries>2</maxretries>
    <layers>
      <layer name="parts" type="Render">
        <cmd>{escaped}</cmd>
        <range>1-{parts}</range>
        <chunk>1</chunk>
        <services>
          <service>shell</service>
        </services>
      </layer>
    </layers>
    <depends/>
  </job>
</spec>
"#
    ))
}

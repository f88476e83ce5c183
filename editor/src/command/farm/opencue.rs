//! OpenCue: a job specification in its XML, with a frame for each part.

use super::FarmJob;

pub(super) fn text(job: &FarmJob) -> Result<String, String> {
    let name = job.name;
    let mut layers = layer("parts", &job.shell_line("#IFRAME#"), &job.numbers.range("x"));
    let mut end = "    <depends/>\n  </job>".to_owned();
    if let Some(last) = job.last_shell_line() {
        layers.push_str(&layer("join", &last, "1-1"));
        end = format!(
            r#"  </job>
  <depends>
    <depend type="LAYER_ON_LAYER" anyframe="False">
      <depjob>{name}</depjob>
      <deplayer>join</deplayer>
      <onjob>{name}</onjob>
      <onlayer>parts</onlayer>
    </depend>
  </depends>"#
        );
    }
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
{layers}    </layers>
{end}
</spec>
"#
    ))
}

/// Returns a layer that runs a command for each frame of a range.
fn layer(name: &str, command: &str, range: &str) -> String {
    let escaped = command
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace('\'', "&apos;");
    format!(
        r#"      <layer name="{name}" type="Render">
        <cmd>{escaped}</cmd>
        <range>{range}</range>
        <chunk>1</chunk>
        <services>
          <service>shell</service>
        </services>
      </layer>
"#
    )
}

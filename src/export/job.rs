//! A job for a render farm: an Open Job Description template.
//!
//! <https://github.com/OpenJobDescription/openjd-specifications>, version 2023-09 with task chunking.

use super::sequence::Sequence;

/// Frames that one task makes, unless the farm says otherwise.
const CHUNK: u32 = 10;

/// The template: frames in chunks, then a video of all of them. The scene is an attached file, which
/// lies beside the template under the name `scene`; `name` is what the job is called.
pub fn job_template(sequence: &Sequence, name: &str, scene: &str) -> String {
    // A JSON text in quotation marks is a YAML one too.
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let (name, scene) = (quoted(name), quoted(scene));
    let frames = quoted(&sequence.frames.to_string());
    let pattern = quoted(&sequence.pattern.text());
    let format = quoted(sequence.format.ending());
    let (width, height) = sequence.size();
    let antialias = quoted(&sequence.antialias());
    format!(
        r#"specificationVersion: jobtemplate-2023-09
extensions: [TASK_CHUNKING]
name: {name}
parameterDefinitions:
  - {{ name: Scene, type: PATH, objectType: FILE, dataFlow: IN, default: {scene} }}
  - {{ name: Output, type: PATH, objectType: DIRECTORY, dataFlow: OUT, default: frames }}
  - {{ name: Frames, type: STRING, default: {frames} }}
  - {{ name: Name, type: STRING, default: {pattern} }}
  - {{ name: Format, type: STRING, default: {format}, allowedValues: [ppm, png] }}
  - {{ name: Width, type: INT, default: {width} }}
  - {{ name: Height, type: INT, default: {height} }}
  - {{ name: Antialias, type: STRING, default: {antialias} }}
  - {{ name: Video, type: STRING, default: video.mp4 }}
  - {{ name: Glint, type: STRING, default: glint, description: The program }}
steps:
  - name: Render
    parameterSpace:
      taskParameterDefinitions:
        - name: Frame
          type: CHUNK[INT]
          range: "{{{{Param.Frames}}}}"
          chunks: {{ defaultTaskCount: {CHUNK}, rangeConstraint: NONCONTIGUOUS }}
    script:
      actions:
        onRun:
          command: "{{{{Param.Glint}}}}"
          args: [export, "{{{{Param.Scene}}}}", -o, "{{{{Param.Output}}}}", --frames, "{{{{Task.Param.Frame}}}}", --name, "{{{{Param.Name}}}}", --format, "{{{{Param.Format}}}}", --width, "{{{{Param.Width}}}}", --height, "{{{{Param.Height}}}}", --antialias, "{{{{Param.Antialias}}}}", --openjd]
  - name: Encode
    dependencies:
      - dependsOn: Render
    script:
      actions:
        onRun:
          command: "{{{{Param.Glint}}}}"
          args: [export, "{{{{Param.Scene}}}}", -o, "{{{{Param.Output}}}}", --frames, "{{{{Param.Frames}}}}", --name, "{{{{Param.Name}}}}", --format, "{{{{Param.Format}}}}", --width, "{{{{Param.Width}}}}", --height, "{{{{Param.Height}}}}", --antialias, "{{{{Param.Antialias}}}}", --video, "{{{{Param.Output}}}}/{{{{Param.Video}}}}", --openjd]
"#
    )
}

//! Topologies whose schemas import others.

use super::*;
use scl_topology::diagnostic::Diagnostic;

/// Names and texts.
type Files<'t> = Vec<(&'t str, &'t str)>;

/// A schema with one message, which is another if `field` is.
pub(super) fn base(field: &str) -> String {
    format!("syntax = \"proto3\";\npackage base;\nmessage Header {{ double {field} = 1; }}\n")
}

/// A schema of the package `name` with a message `Main` that contains the header of `import`.
pub(super) fn importer(name: &str, import: &str) -> String {
    format!("syntax = \"proto3\";\npackage {name};\nimport \"{import}\";\nmessage Main {{ base.Header header = 1; }}\n")
}

/// A topology with these lines about schemas, whose gates carry `base.Header`.
pub(super) fn with_schemas(lines: &str) -> String {
    typed("[]", "base.Header").replace("schemas: []", lines)
}

/// The errors and their ways out, without excerpts.
pub(super) fn told(files: &[(&str, &str)], name: &str) -> String {
    let loaded = load_from(&folder(files), name);
    assert_eq!(loaded.topology.is_none(), !errors(&loaded).is_empty());
    let problems = loaded.diagnostics.iter().filter(|problem| problem.severity != Severity::Lint);
    let helps =
        |problem: &Diagnostic| problem.shown_helps().map(|help| format!("\n{}", help.text())).collect::<String>();
    problems.map(|problem| format!("{}{}", problem.message, helps(problem))).collect::<Vec<_>>().join("\n")
}

/// The first field of `base.Header` as compiled.
fn field(files: &[(&str, &str)], name: &str) -> String {
    let loaded = load_from(&folder(files), name);
    assert_eq!(rendered(&loaded), "");
    let schemas = loaded.schemas.unwrap();
    let file = schemas.file_descriptor_set.file.iter().find(|file| file.package() == "base").unwrap();
    file.message_type[0].field[0].name().to_owned()
}

#[test]
fn an_import_that_two_files_answer_is_refused() {
    let (here, there) = (base("x"), base("y"));
    let (nav, arm) = (importer("nav", "common.proto"), importer("arm", "common.proto"));
    let files = [
        ("t.yaml", with_schemas("schemas: [nav/fix.proto, arm/joint.proto]")),
        ("nav/fix.proto", nav.clone()),
        ("arm/joint.proto", arm),
        ("nav/common.proto", here.clone()),
        ("arm/common.proto", there.clone()),
    ];
    let mut files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    says(
        &files,
        "t.yaml",
        expect![[r#"
            error: [SCL0406] the import `common.proto` in `nav/fix.proto` can mean two files: `nav/common.proto` and `arm/common.proto`
             --> nav/fix.proto:3:1
              |
            3 | import "common.proto";
              | ^^^^^^^^^^^^^^^^^^^^^^ imported here
              |
             ::: t.yaml:1:11
              |
            1 | schemas: [nav/fix.proto, arm/joint.proto]
              |           ------------- compiled because of this line
              |
             ::: arm/joint.proto:3:1
              |
            3 | import "common.proto";
              | ---------------------- and here
              |
              = help: both declare the same messages, and differ in line 3: make them equal, or keep only one
              = note: imports are looked for beside the topology file and beside each of its `schemas`
              = note: 2 places have it
        "#]],
    );
    let reversed = with_schemas("schemas: [arm/joint.proto, nav/fix.proto]");
    files[0].1 = &reversed;
    assert!(told(&files, "t.yaml").contains("can mean two files: `arm/common.proto` and `nav/common.proto`"));

    let beside = with_schemas("schemas: [nav/fix.proto]");
    let files =
        [("t.yaml", &*beside), ("nav/fix.proto", &*nav), ("nav/common.proto", &*here), ("common.proto", &*there)];
    expect![[r#"
        the import `common.proto` in `nav/fix.proto` can mean two files: `common.proto` and `nav/common.proto`
        both declare the same messages, and differ in line 3: make them equal, or keep only one"#]]
    .assert_eq(&told(&files, "t.yaml"));
    // An entry is a path and means one file, but the import means two.
    let entry = with_schemas("schemas: [common.proto, nav/fix.proto]");
    let files = [("t.yaml", &*entry), files[1], files[2], files[3]];
    assert!(told(&files, "t.yaml").contains("can mean two files: `common.proto` and `nav/common.proto`"));
}

#[test]
fn an_import_that_copies_of_one_file_answer_is_taken() {
    let (text, nav, arm) = (base("x"), importer("nav", "common.proto"), importer("arm", "common.proto"));
    let yaml = with_schemas("schemas: [nav/fix.proto, arm/joint.proto]");
    let files = [("t.yaml", &*yaml), ("nav/fix.proto", &*nav), ("arm/joint.proto", &*arm)];
    let copies = [files[0], files[1], files[2], ("nav/common.proto", &*text), ("arm/common.proto", &*text)];
    assert_eq!(field(&copies, "t.yaml"), "x");
    let folder = folder(&copies);
    let read = load_from(&folder, "t.yaml").files_read;
    assert!(read.contains(&folder.path().join("arm/common.proto")), "{read:?}");
    // A link to the same file.
    fs::remove_file(folder.path().join("arm/common.proto")).unwrap();
    std::os::unix::fs::symlink(folder.path().join("nav/common.proto"), folder.path().join("common.proto")).unwrap();
    assert_eq!(rendered(&load_from(&folder, "t.yaml")), "");
}

#[test]
fn a_name_that_two_files_have_and_nobody_imports_does_no_harm() {
    let (one, two) = (base("x"), base("y").replace("package base", "package other"));
    let yaml = with_schemas("schemas: [nav/common.proto, arm/common.proto]");
    assert_eq!(field(&[("t.yaml", &yaml), ("nav/common.proto", &one), ("arm/common.proto", &two)], "t.yaml"), "x");
    // A folder of that name is no file.
    let yaml = with_schemas("schemas: [nav/fix.proto]");
    let nav = importer("nav", "common.proto");
    let files = [("t.yaml", &*yaml), ("nav/fix.proto", &*nav), ("nav/common.proto", &*one), ("common.proto/a", "")];
    assert_eq!(field(&files, "t.yaml"), "x");
}

#[test]
fn a_copy_of_a_file_of_protobuf_itself_has_no_effect() {
    let main = "syntax = \"proto3\";\npackage base;\nimport \"google/protobuf/timestamp.proto\";\n\
                message Header { google.protobuf.Timestamp at = 1; }\n";
    let copy = "syntax = \"proto3\";\npackage google.protobuf;\nmessage Timestamp { string text = 1; }\n";
    let yaml = with_schemas("schemas: [a.proto]");
    let folder = folder(&[("t.yaml", &yaml), ("a.proto", main), ("google/protobuf/timestamp.proto", copy)]);
    let schemas = load_from(&folder, "t.yaml").schemas.unwrap();
    assert_eq!(schemas.file_descriptor_set.file[0].message_type[0].field[0].name(), "seconds");
}

#[test]
fn an_import_with_dots_is_refused_with_the_path_to_write() {
    let (text, nav) = (base("x"), importer("nav", "../common/header.proto"));
    let yaml = with_schemas("schemas: [proto/nav/fix.proto]");
    let files = [("t.yaml", &*yaml), ("proto/nav/fix.proto", &*nav), ("proto/common/header.proto", &*text)];
    says(
        &files,
        "t.yaml",
        expect![[r#"
            error: [SCL0406] the import `../common/header.proto` in `proto/nav/fix.proto` is not a path below an import folder
             --> proto/nav/fix.proto:3:1
              |
            3 | import "../common/header.proto";
              | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ imported here
              |
             ::: t.yaml:1:11
              |
            1 | schemas: [proto/nav/fix.proto]
              |           ------------------- compiled because of this line
              |
              = help: write `import "proto/common/header.proto";`
              = note: protobuf does not allow `.`, `..`, `\` or absolute paths in imports
        "#]],
    );
    let mut written = String::new();
    for name in
        ["./near.proto", "/near.proto", "nav//near.proto", "..\\\\\\\\common\\\\\\\\header.proto", "../nowhere.proto"]
    {
        let nav = importer("nav", name);
        let near = base("x");
        let files = [files[0], ("proto/nav/fix.proto", &*nav), files[2], ("proto/nav/near.proto", &*near)];
        written += &format!("{}\n", told(&files, "t.yaml"));
    }
    expect![[r#"
        the import `./near.proto` in `proto/nav/fix.proto` is not a path below an import folder
        write `import "proto/nav/near.proto";`
        the import `/near.proto` in `proto/nav/fix.proto` is not a path below an import folder
        the import `nav//near.proto` in `proto/nav/fix.proto` is not a path below an import folder
        the import `..\\\\common\\\\header.proto` in `proto/nav/fix.proto` is not a path below an import folder
        write `import "proto/common/header.proto";`
        the import `../nowhere.proto` in `proto/nav/fix.proto` is not a path below an import folder
    "#]]
    .assert_eq(&written);
}

#[test]
fn an_import_from_a_folder_above_proposes_that_folder() {
    let (text, nav) = (base("x"), importer("nav", "common/header.proto"));
    let yaml = with_schemas("schemas: [proto/nav/fix.proto]");
    let mut files = [("t.yaml", &*yaml), ("proto/nav/fix.proto", &*nav), ("proto/common/header.proto", &*text)];
    says(
        &files,
        "t.yaml",
        expect![[r#"
        error: [SCL0406] cannot find `common/header.proto`, which `proto/nav/fix.proto` imports
         --> proto/nav/fix.proto:3:1
          |
        3 | import "common/header.proto";
          | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ imported here
          |
         ::: t.yaml:1:11
          |
        1 | schemas: [proto/nav/fix.proto]
          |           ------------------- compiled because of this line
          |
          = help: name the folder in which imports begin: `schema_roots: [proto]`
          = note: imports are looked for beside the topology file and beside each of its `schemas`
    "#]],
    );
    let with_root = with_schemas("schemas: [proto/nav/fix.proto]\nschema_roots: [./proto/]");
    files[0].1 = &with_root;
    assert_eq!(field(&files, "t.yaml"), "x");
    // Above the topology file.
    let beside = with_schemas("schemas: [fix.proto]");
    let deep = [("nav/t.yaml", &*beside), ("nav/fix.proto", &*nav), ("common/header.proto", &*text)];
    expect![[r#"
        cannot find `common/header.proto`, which `fix.proto` imports
        name the folder in which imports begin: `schema_roots: [..]`"#]]
    .assert_eq(&told(&deep, "nav/t.yaml"));
    let with_root = with_schemas("schemas: [fix.proto]\nschema_roots: [..]");
    let deep = [("nav/t.yaml", &*with_root), deep[1], deep[2]];
    expect![[r#"
        the schema path leaves the folder of the topology file; it will not be found if only that folder is copied
        keep the schema beside the topology file, or in a folder below it"#]]
    .assert_eq(&told(&deep, "nav/t.yaml"));
}

#[test]
fn entries_are_known_by_their_names_below_a_root() {
    let (text, nav) = (base("x"), importer("nav", "common/header.proto"));
    let yaml = with_schemas("schemas: [proto/common/header.proto, third/nav/fix.proto]\nschema_roots: [proto, third]");
    let files = [("t.yaml", &*yaml), ("third/nav/fix.proto", &*nav), ("proto/common/header.proto", &*text)];
    let loaded = load_from(&folder(&files), "t.yaml");
    assert_eq!(rendered(&loaded), "");
    let schemas = loaded.schemas.unwrap();
    let names: Vec<&str> = schemas.file_descriptor_set.file.iter().map(|file| file.name()).collect();
    assert_eq!(names, ["common/header.proto", "nav/fix.proto"]);
    assert_eq!(schemas.folders, ["proto", "third"]);
}

#[test]
fn mistakes_with_roots_have_ways_out() {
    let (text, other) = (base("x"), base("y"));
    let nav = |import| importer("nav", import);
    let (rooted, near, missing) = (nav("common/header.proto"), nav("header.proto"), nav("common/heder.proto"));
    let cases: [(&str, &str, Files<'_>); 8] = [
        ("no folder", "schemas: [a/fix.proto]\nschema_roots: [b, a]", vec![("a/fix.proto", &text)]),
        (
            "outside",
            "schemas: [a/fix.proto, fix.proto]\nschema_roots: [a]",
            vec![("a/fix.proto", &text), ("fix.proto", "")],
        ),
        (
            "hidden",
            "schemas: [b/fix.proto]\nschema_roots: [a, b]",
            vec![("a/fix.proto", &text), ("b/fix.proto", &other)],
        ),
        (
            "two roots",
            "schemas: [a/nav/fix.proto]\nschema_roots: [a, b]",
            vec![("a/nav/fix.proto", &rooted), ("a/common/header.proto", &text), ("b/common/header.proto", &other)],
        ),
        (
            "beside",
            "schemas: [a/nav/fix.proto]\nschema_roots: [a]",
            vec![("a/nav/fix.proto", &near), ("a/nav/header.proto", &text)],
        ),
        (
            "another root",
            "schemas: [a/nav/fix.proto]\nschema_roots: [a]",
            vec![("a/nav/fix.proto", &rooted), ("common/header.proto", &text)],
        ),
        (
            "misspelt",
            "schemas: [a/nav/fix.proto]\nschema_roots: [a]",
            vec![("a/nav/fix.proto", &missing), ("a/common/header.proto", &text)],
        ),
        (
            "two names",
            "schemas: [proto/header.proto, proto/fix.proto]",
            vec![("proto/fix.proto", &near), ("proto/header.proto", &text)],
        ),
    ];
    let all = cases.iter().map(|(case, lines, files)| {
        let yaml = with_schemas(lines);
        let files: Files<'_> = files.iter().copied().chain([("t.yaml", &*yaml)]).collect();
        format!("{case}: {}\n", told(&files, "t.yaml"))
    });
    expect![[r#"
        no folder: cannot find the folder `b`
        outside: the schema `fix.proto` is in none of the folders of `schema_roots`
        `schema_roots` lists the folders in which imports begin
        hidden: the schema `b/fix.proto` has the same path in its root as another file
        rename one of the files, or remove its folder from `schema_roots`
        two roots: the import `common/header.proto` in `a/nav/fix.proto` can mean two files: `a/common/header.proto` and `b/common/header.proto`
        both declare the same messages, and differ in line 3: make them equal, or keep only one
        beside: cannot find `header.proto`, which `a/nav/fix.proto` imports
        write `import "nav/header.proto";`
        another root: cannot find `common/header.proto`, which `a/nav/fix.proto` imports
        name the folder in which imports begin: `schema_roots: [a, .]`
        misspelt: cannot find `common/heder.proto`, which `a/nav/fix.proto` imports
        a file with a similar name exists: `common/header.proto`
        two names: `header.proto`, which `proto/fix.proto` imports, is the schema `proto/header.proto` under another name
        name the folder in which imports begin: `schema_roots: [proto]`
    "#]].assert_eq(&all.collect::<String>());
}

#[test]
fn a_mistake_in_a_file_that_two_entries_import_is_told_once() {
    let wrong = importer("base", "nowhere.proto");
    let (one, two) = (importer("one", "base.proto"), importer("two", "base.proto"));
    let yaml = with_schemas("schemas: [one.proto, two.proto]");
    let files = [("t.yaml", &*yaml), ("one.proto", &*one), ("two.proto", &*two), ("base.proto", &*wrong)];
    expect!["cannot find `nowhere.proto`, which `base.proto` imports"].assert_eq(&told(&files, "t.yaml"));
}

use super::*;
use crate::import::ImportReport;

fn parse(text: &str) -> (Vec<(u32, String)>, Vec<String>) {
    let mut warnings = Warnings::new("t.step");
    let file = File::parse(text.as_bytes(), "t.step", &mut warnings).expect("a STEP file");
    let show = |r: &Record| {
        let parts: Vec<String> = file.parts(r).map(|(name, values)| format!("{name}{}", brief(values))).collect();
        (r.id, parts.join(" "))
    };
    let records = file.records.iter().map(show).collect();
    (records, warnings.finish(&mut ImportReport::default()).iter().map(ToString::to_string).collect())
}

/// Values in one line, decoded.
fn brief(values: Values<'_>) -> String {
    let one = |v: Value<'_>| match v {
        Value::Integer(i) => i.to_string(),
        Value::Real(x) => format!("{x:?}"),
        Value::Text(raw) => format!("'{}'", decode(raw)),
        Value::Enumeration(name) => format!(".{name}."),
        Value::Reference(id) => format!("#{id}"),
        Value::List(inner) => brief(inner),
        Value::Typed(inner) => format!("typed{}", brief(inner)),
        Value::Omitted => "$".into(),
        Value::Derived => "*".into(),
    };
    format!("({})", values.map(one).collect::<Vec<_>>().join(","))
}

fn data(records: &str) -> String {
    format!("ISO-10303-21;HEADER;FILE_SCHEMA(('X'));ENDSEC;DATA;\n{records}\nENDSEC;END-ISO-10303-21;")
}

/// The one record of a data section without warnings.
fn one(record: &str) -> String {
    let (records, warnings) = parse(&data(record));
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(records.len(), 1, "{records:?}");
    records[0].1.clone()
}

#[test]
fn every_kind_of_parameter() {
    assert_eq!(
        one("#1=A(1,-2,+3,1.,-.5,1.E-07,2.5D3,.T.,.UNSPECIFIED.,#7,$,*,'x',(1,(2,3)),M(0.5),\"0FF\");"),
        "A(1,-2,3,1.0,-0.5,1e-7,2500.0,.T.,.UNSPECIFIED.,#7,$,*,'x',(1,(2,3)),typed(0.5),'0FF')"
    );
}

#[test]
fn empty_lists_and_trailing_commas() {
    assert_eq!(one("#1=A();"), "A()");
    assert_eq!(one("#1=A((),());"), "A((),())");
    assert_eq!(one("#1=A((1,2,),3,);"), "A((1,2),3)");
    assert_eq!(one("#1=A(1,,2);"), "A(1,$,2)");
}

#[test]
fn strings_hide_everything() {
    assert_eq!(one("#1=A('it''s; #2=B(/*');"), "A('it's; #2=B(/*')");
    assert_eq!(one("#1=A('','''');"), "A('',''')");
    assert_eq!(one("#1=A('\\X2\\03B1\\X0\\');"), "A('α')");
}

#[test]
fn comments_and_white_space_anywhere() {
    assert_eq!(one("/*a*/#1/*b*/=/*;*/A/**/(/*'*/1/***/,\r\n\t2/*#2=B();*/)/**/;"), "A(1,2)");
}

#[test]
fn complex_instances() {
    assert_eq!(one("#1=(A(1) B() C((2),$));"), "A(1) B() C((2),$)");
    assert_eq!(one("#1=(\nA(1)B()\n);"), "A(1) B()");
}

#[test]
fn scopes_are_flattened() {
    let (records, warnings) =
        parse(&data("#9=&SCOPE\n#1=A();\n#8=&SCOPE #2=B(); ENDSCOPE C();\nENDSCOPE /#1,#2/ D(#1);"));
    assert!(warnings.is_empty(), "{warnings:?}");
    let names: Vec<_> = records.iter().map(|r| format!("{} {}", r.0, r.1)).collect();
    assert_eq!(names, ["1 A()", "2 B()", "8 C()", "9 D(#1)"]);
}

#[test]
fn several_data_sections_and_other_sections() {
    let text = "ISO-10303-21;HEADER;ENDSEC;ANCHOR;<a>=#1;ENDSEC;DATA('x',('S'));#1=A();ENDSEC;\
                DATA;#2=B();ENDSEC;SIGNATURE;abc;ENDSEC;END-ISO-10303-21;";
    let (records, warnings) = parse(text);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(records.iter().map(|r| r.0).collect::<Vec<_>>(), [1, 2]);
}

/// Files that are put together have one end each: the second is left out, and that is a loss.
#[test]
fn text_behind_the_end_is_reported() {
    let whole = data("#1=A();");
    for (rest, told) in [
        ("\n\0 \u{1a}/* end */\n", ""),
        ("\nSIGNATURE;\nabc\nENDSEC;\n", ""),
        ("\n\nSent by mail", "t.step:5: text not used: it stands behind END-ISO-10303-21"),
        (format!("\n{whole}").as_str(), "t.step:4: second file left out: it stands behind END-ISO-10303-21"),
    ] {
        let (records, warnings) = parse(&format!("{whole}{rest}"));
        assert_eq!((records.len(), warnings.join("; ").as_str()), (1, told), "{rest:?}");
    }
}

#[test]
fn missing_header_and_byte_order_mark() {
    let (records, warnings) = parse("\u{feff}\n ISO-10303-21;\nDATA;#1=A();ENDSEC;END-ISO-10303-21;");
    assert_eq!((records.len(), warnings.len()), (1, 0));
}

#[test]
fn records_in_any_order_and_sparse() {
    let mut warnings = Warnings::new("t");
    let text = data("#4294967295=Z();#10=A();#3=B();#11=C();#10=D();");
    let file = File::parse(text.as_bytes(), "t", &mut warnings).unwrap();
    let name = |id| file.record(id).map(|r| file.parts(r).next().unwrap().0);
    assert_eq!(
        [name(3), name(10), name(11), name(4294967295), name(4), name(0)],
        [Some("B"), Some("A"), Some("C"), Some("Z"), None, None]
    );
    assert_eq!(file.of_kind("C").collect::<Vec<_>>(), [11]);
    let list = warnings.finish(&mut ImportReport::default());
    assert_eq!(list[0].to_string(), "t:2: #10: number used twice: the first record counts");
}

/// A bad record costs itself only; the warning has its line and number.
#[test]
fn bad_records_are_skipped_alone() {
    for bad in [
        "#5=A(1.#QNAN);",
        "#5=A('not closed);",
        "#5=A(/* not closed);",
        "#5=A(1 2);",
        "#5=A(1;",
        "#5=A 1;",
        "#5 A();",
        "#5=A(.T);",
        "#5=A(#99999999999);",
        "#5=;",
        "#5=A(1)) ;",
        "#5=A(@3);",
        "#5=(A(1) 7);",
        "#5=A(\"0);",
    ] {
        let (records, warnings) = parse(&data(&format!("#1=X();\n{bad}\n#6=Y('');\n#7=Z();")));
        let ids: Vec<u32> = records.iter().map(|r| r.0).collect();
        assert_eq!(ids, [1, 6, 7], "{bad}: {warnings:?}");
        assert!(warnings[0].starts_with("t.step:3: #5: record skipped: "), "{bad}: {warnings:?}");
    }
}

#[test]
fn not_a_number_keeps_the_record() {
    assert_eq!(one("#1=A(NaN,inf);"), "A(NaN,NaN)");
    assert_eq!(one("#1=A(1E999);"), "A(inf)");
}

#[test]
fn forgotten_semicolon_costs_nothing() {
    let (records, warnings) = parse(&data("#1=A(1)\n#2=B(2);\n#3=C()"));
    assert_eq!(records.len(), 3);
    assert_eq!(warnings[0], "t.step:3: missing `;`: the statement before it is taken as complete");
    assert_eq!(warnings.len(), 2);
}

#[test]
fn deep_nesting_is_refused() {
    let deep = format!("#1=A({}1{});\n#2=B();", "(".repeat(100_000), ")".repeat(100_000));
    let (records, warnings) = parse(&data(&deep));
    assert_eq!(records.len(), 1);
    assert!(warnings[0].contains("nested too deep"), "{warnings:?}");
}

#[test]
fn truncated_files_keep_what_is_there() {
    let text = data("#1=A(1);\n#2=B('long string',(1,2,3));\n#3=C(4);");
    let mut counts = Vec::new();
    for end in text.find("DATA;").unwrap() + 5..text.len() - 20 {
        let (records, warnings) = parse(&text[..end]);
        assert!(!warnings.is_empty(), "cut at {end}");
        counts.push(records.len());
    }
    assert_eq!((counts[0], counts[counts.len() - 1]), (0, 3));
    assert!(counts.is_sorted());
}

fn error(text: &[u8]) -> ImportError {
    File::parse(text, "t.step", &mut Warnings::new("t.step")).unwrap_err()
}

#[test]
fn what_is_not_step_is_an_error() {
    assert!(matches!(error(b""), ImportError::NotStep { .. }));
    assert!(matches!(error(b"solid cube\nfacet normal 0 0 1"), ImportError::NotStep { .. }));
    assert!(matches!(error(&[0xff; 10_000]), ImportError::NotStep { .. }));
    assert!(matches!(error(b"ISO-10303-21;\nHEADER;\nENDSEC;"), ImportError::NoData { line: 3, .. }));
}

/// Linear time on input that could make a scanner start over and over: unclosed comments and strings, records that go
/// wrong at their end. 16 MB each; a quadratic scan would take hours.
#[test]
fn nonsense_ends_soon() {
    for (unit, closing) in [
        ("#1=A(/*;", ""),
        ("#1=A(/*;", "*/"),
        ("#1=A('';'", ""),
        ("#1=A(1,1,1,1\n", ""),
        (";#", ""),
        ("~!@%^&", ""),
        ("#1=A(", ""),
        ("&SCOPE #1=&SCOPE ", ""),
    ] {
        let text = format!("ISO-10303-21;DATA;{}{closing}", unit.repeat((16 << 20) / unit.len()));
        let start = std::time::Instant::now();
        let mut warnings = Warnings::new("t.step");
        let records = File::parse(text.as_bytes(), "t.step", &mut warnings).map_or(0, |f| f.records.len());
        assert!(records <= 1, "{unit}: {records}");
        assert!(warnings.finish(&mut ImportReport::default()).len() < 40);
        assert!(start.elapsed().as_secs() < 20, "{unit} took {:?}", start.elapsed());
    }
}

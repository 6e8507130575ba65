//! Entries and sections in the shapes of other tools.

use super::told;
use expect_test::expect;

#[test]
fn other_shapes_are_understood() {
    let texts = [
        "components:\n- name: a\n  command: ./a\n- name: b\n  command: ./b\n",
        "components:\n  - a:\n      command: ./a\n  - b: {command: ./b}\n",
        "components:\n  - {name: a, command: ./a}\n",
        "components: {a: ./a, b: [./b, -v]}\n",
        "a:\n  command: ./a\nb:\n  command: ./b\n",
        "components:\n  a:\n    command: ./a\nb:\n  command: ./b\n",
        "services:\n  a: {command: ./a}\nversion: '3'\n",
        "restart: always\ncomponents: {a: {command: ./a}}\n",
        "components: {a: {command: ./a}}\ntransports: shm\n",
        "components: {a: {command: ./a}}\ntransports: {images: shm}\n",
        "components: {x: {command: ./a}, b: {command: ./b}}\ntransports: {x.images: shm}\n",
        "components: {a: {command: ./a, input: terminal}, b: {command: ./b, input: terminal}}\n",
        "components: {a: {command: ./a}}\ndefaults: always\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nhosts:\n  one: {address: 'tcp://127.0.0.1:80', components: a}\n  two: {address: 127.0.0.2}\ngateway: 7447\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles:\n  debug: {command: ./a -v}\n",
        "components: {a: {command: ./a, opens: [b.images]}, b: {command: ./b, opens: b}}\n",
        "a: ./a -v\nb: ./b\n",
        "components: {a: {command: ./a}}\nenvironment:\n- A=b\n- C=\n",
        "components: {a: {command: ./a}}\nenvironment: {A: b,c=d, E: 1}\n",
        "components: {a: {command: ./a}}\ndefaults: {env: {A: 1}}\n",
        "components:\n  a: {command: ./a}\n  a: {restart: always, environment: {A: 1}}\n",
        "components:\n  a: {command: ./a}\n  a: {command: ./b}\n",
        "components:\n  a:\n    command: ./a\ntransport: ipc\ncomponents:\n  b:\n    command: ./b\n    cpu: 1\n",
        "components:\n  a:\n  command:\n    - ./a\n  cpu: 1\n  b:\n    command: ./b\n",
        "components:\n  a:\n    command: ./a\n    profiles: [debug]\n    cpu: 1\n  b: {command: ./b}\n",
        "components: {a: {command: ./a}}\nprofiles:\n  debug:\n    environment: {A: 1}\n    a: {cpu: 1}\n    b: {cpu: 2}\n    transport: shm\n",
        "components: {a: {command: ./a}, gateway: {command: ./b}}\nhosts: {one: {address: '127,0,0,1', components: [a]}}\ngateway: {port: 80}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nhosts:\n  one:\n    address: tcp/127.0.0.1:80\n    components: [a]\n  two: {address: 'http://127.0.0.2:81', components: [b]}\ngateway: {port: 80}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles:\n  debug:\n    components:\n      a: {command: ./x}\n  sim:\n    command: ./a_sim\n    restart: never\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\ntransports:\n  a.images: shm\n  board: {address: 127.0.0.1, components: [a, b]}\ngateway: {port: 80}\n",
        "components: {a: {command: ./a}, b: {command: ./b, machine: two}}\nhosts:\n  one: {address: 127.0.0.1, components: [a]}\n  two: {address: 127.0.0.2}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nhosts:\n  one: {address: 192.0.2.1, components: [a, b], insecure: true}\n  two: {address: 192.0.2.2, components: [b]}\ngateway: {port: 80}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles:\n  a:\n    command: [./a, -v]\n  b:\n    command: ./b\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles: {a: {command: ./x}}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles:\n  active: debug\n  debug: {a: {cpu: 1}}\n",
    ];
    let all = texts.map(|text| format!("# {text}{}", told(text)));
    let all = all.join("");
    expect![[r##"
        # components:
        - name: a
          command: ./a
        - name: b
          command: ./b
        `components` is a mapping from names to entries, not a list
          write each name as a key, in place of its `-`
            => a: | command: ./a | b: | command: ./b
        # components:
          - a:
              command: ./a
          - b: {command: ./b}
        `components` is a mapping from names to entries, not a list
          write each name as a key, in place of its `-`
            => a: | b: {command: ./b}
        # components:
          - {name: a, command: ./a}
        `components` is a mapping from names to entries, not a list
          write each name as a key, in place of its `-`
            => a: {command: ./a}
        # components: {a: ./a, b: [./b, -v]}
        the entry of component `a` is a mapping, not `./a`
          write `a: {command: ./a}`
            => components: {a: {command: ./a}, b: [./b, -v]}
        the entry of component `b` is a mapping, not a list
          write `b: {command: [./b, -v]}`
            => components: {a: ./a, b: {command: [./b, -v]}}
        # a:
          command: ./a
        b:
          command: ./b
        component `a` stands at the top of the file
          write `components:` above it, and indent it
            => components: | a: | command: ./a | b: | command: ./b
        # components:
          a:
            command: ./a
        b:
          command: ./b
        component `b` stands at the top of the file
          indent it below `components`
            => b: | command: ./b
        # services:
          a: {command: ./a}
        version: '3'
        unknown key `services` in a launch file
          did you mean `components`?
            => components:
        unknown key `version` in a launch file
          remove `version`
            ?> 
          (a launch file has no version and no kind)
        # restart: always
        components: {a: {command: ./a}}
        unknown key `restart` in a launch file
          for all components, `restart` stands in `defaults`
            ?> defaults: {restart: always}
        # components: {a: {command: ./a}}
        transports: shm
        `transports` is a mapping, not `shm`
          write `transport: shm`
            => transport: shm
        # components: {a: {command: ./a}}
        transports: {images: shm}
        a gate is named `component.gate`, not `images`
          did you mean `a.images`?
            ?> transports: {a.images: shm}
          did you mean `b.images`?
            ?> transports: {b.images: shm}
        # components: {x: {command: ./a}, b: {command: ./b}}
        transports: {x.images: shm}
        unknown component `x`
          did you mean `a`?
            ?> components: {a: {command: ./a}, b: {command: ./b}} | transports: {a.images: shm}
          (the topology has the components `a`, `b`)
        # components: {a: {command: ./a, input: terminal}, b: {command: ./b, input: terminal}}
        the components `a` and `b` both have `input: terminal`
          remove `input` from `a`
            ?> components: {a: {command: ./a}, b: {command: ./b, input: terminal}}
          remove `input` from `b`
            ?> components: {a: {command: ./a, input: terminal}, b: {command: ./b}}
          (only one component can read from the terminal)
        # components: {a: {command: ./a}}
        defaults: always
        `defaults` is a mapping, not `always`
          write `defaults: {restart: always}`
            => defaults: {restart: always}
        # components: {a: {command: ./a}, b: {command: ./b}}
        hosts:
          one: {address: 'tcp://127.0.0.1:80', components: a}
          two: {address: 127.0.0.2}
        gateway: 7447
        `address` is an address alone, not `tcp://127.0.0.1:80`
          write `address: 127.0.0.1` and `port: 80`
            => one: {address: 127.0.0.1, port: 80, components: a}
        host `one` has no list of `components`
          write `components: [a]`
            => one: {address: 'tcp://127.0.0.1:80', components: [a]}
        host `two` has no list of `components`
          what is on no other host: `components: [a, b]`
            ?> two: {address: 127.0.0.2, components: [a, b]}
        `gateway` is a mapping, not `7447`
          with all hosts on this machine: `gateway: {port: 7447}`
            ?> gateway: {port: 7447}
          with certificates, which `scl gateway keys` makes: `gateway: {port: 7447, certificates: ./keys}`
            ?> gateway: {port: 7447, certificates: ./keys}
          without certificates, so that everybody on the network can listen and send: `gateway: {port: 7447, insecure: true}`
            ?> gateway: {port: 7447, insecure: true}
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles:
          debug: {command: ./a -v}
        profile `debug` has the key `command` in place of components
          write `a: {command: ./a -v}`
            ?> debug: {a: {command: ./a -v}}
          (a profile is a mapping from components to entries)
        # components: {a: {command: ./a, opens: [b.images]}, b: {command: ./b, opens: b}}
        unknown component `b.images`
          did you mean `b`?
            ?> components: {a: {command: ./a, opens: [b]}, b: {command: ./b, opens: b}}
          (components are listed here, not gates)
          (a launch file starts the components of the topology, and nothing else)
          (the topology has the components `a`, `b`)
        `opens` is a list of components like `[sensor, controller]`, or `any`, not `b`
          write `opens: [b]`
            => components: {a: {command: ./a, opens: [b.images]}, b: {command: ./b, opens: [b]}}
        # a: ./a -v
        b: ./b
        component `a` stands at the top of the file
          write `components:` above it, and indent it
            => components: | a: {command: ./a -v} | b: {command: ./b}
        # components: {a: {command: ./a}}
        environment:
        - A=b
        - C=
        `environment` is a mapping, not a list
          write `environment: {A: b, C: ""}`
            => environment: {A: b, C: ""}
        # components: {a: {command: ./a}}
        environment: {A: b,c=d, E: 1}
        `c=d` is not the name of an environment variable
          a text with a comma needs quotes: `"b,c=d"`
            ?> environment: {A: "b,c=d", E: 1}
        # components: {a: {command: ./a}}
        defaults: {env: {A: 1}}
        unknown key `env` in `defaults`
          `environment` belongs at the top of the file
        # components:
          a: {command: ./a}
          a: {restart: always, environment: {A: 1}}
        the key `a` is written twice in `components`
          write what is here in the first `a`
            ?> a: {command: ./a, restart: always, environment: {A: 1}}
          (YAML tools disagree which one wins: PyYAML silently keeps the second)
        # components:
          a: {command: ./a}
          a: {command: ./b}
        the key `a` is written twice in `components`
          remove the second one
            ?> 
          remove the first one
            ?> 
          (YAML tools disagree which one wins: PyYAML silently keeps the second)
        # components:
          a:
            command: ./a
        transport: ipc
        components:
          b:
            command: ./b
            cpu: 1
        the key `components` is written twice in a launch file
          write what is here in the first `components`
            ?> 
          (YAML tools disagree which one wins: PyYAML silently keeps the second)
        # components:
          a:
          command:
            - ./a
          cpu: 1
          b:
            command: ./b
        `command` stands beside `a`, not in its entry
          indent the keys by 4 spaces, below `a`
            => command: | - ./a | cpu: 1
        # components:
          a:
            command: ./a
            profiles: [debug]
            cpu: 1
          b: {command: ./b}
        unknown key `profiles` in component `a`
          move the entry from `components` into a profile, at the top of the file: `profiles: {debug: {a: {command: ...}}}`
            ?> profiles: | debug: | a: | command: ./a | cpu: 1
        # components: {a: {command: ./a}}
        profiles:
          debug:
            environment: {A: 1}
            a: {cpu: 1}
            b: {cpu: 2}
            transport: shm
        profile `debug` has the key `environment` in place of a component
          `environment` belongs into the entries of components: move it to `a`, `b`
            ?> a: {cpu: 1, environment: {A: 1}} | b: {cpu: 2, environment: {A: 1}}
          (a profile holds entries of components only)
        `b` needs a `command` or a `replay` in profile `debug`
          (`components` has no entry `b`)
        profile `debug` has the key `transport` in place of a component
          `transport` belongs at the top of the file
          (a profile holds entries of components only)
        # components: {a: {command: ./a}, gateway: {command: ./b}}
        hosts: {one: {address: '127,0,0,1', components: [a]}}
        gateway: {port: 80}
        unknown component `gateway`
          did you mean `b`?
            ?> components: {a: {command: ./a}, b: {command: ./b}}
          (the topology has the components `a`, `b`)
        with `hosts`, no component can be called `gateway`
          give it another name here and in the topology, for example `radio_gateway`
          (this is the name of the program that connects the hosts)
        component `b` is on no host
          add `b` to `components` of host `one`
            ?> hosts: {one: {address: '127,0,0,1', components: [a, b]}}
        `address` is an IP address or a DNS name, not `127,0,0,1`
          write `address: 127.0.0.1`
            => hosts: {one: {address: 127.0.0.1, components: [a]}}
        # components: {a: {command: ./a}, b: {command: ./b}}
        hosts:
          one:
            address: tcp/127.0.0.1:80
            components: [a]
          two: {address: 'http://127.0.0.2:81', components: [b]}
        gateway: {port: 80}
        `address` is an address alone, not `tcp/127.0.0.1:80`
          write `address: 127.0.0.1`
            => address: 127.0.0.1
        `address` is an address alone, not `http://127.0.0.2:81`
          write `address: 127.0.0.2`
            ?> two: {address: 127.0.0.2, components: [b]}
          write `address: 127.0.0.2` and `port: 81`, in place of port 80 of `gateway`
            ?> two: {address: 127.0.0.2, port: 81, components: [b]}
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles:
          debug:
            components:
              a: {command: ./x}
          sim:
            command: ./a_sim
            restart: never
        profile `debug` has `components` in place of their entries
          remove `components:`
            => a: {command: ./x}
          (a profile is a mapping from components to entries)
        profile `sim` has the key `command` in place of components
          write `a:` above it, and indent it
            ?> a: | command: ./a_sim | restart: never
          (a profile is a mapping from components to entries)
        # components: {a: {command: ./a}, b: {command: ./b}}
        transports:
          a.images: shm
          board: {address: 127.0.0.1, components: [a, b]}
        gateway: {port: 80}
        `hosts:` is missing above `board`
          write `hosts:` above it
            => hosts:
        # components: {a: {command: ./a}, b: {command: ./b, machine: two}}
        hosts:
          one: {address: 127.0.0.1, components: [a]}
          two: {address: 127.0.0.2}
        unknown key `machine` in component `b`
          list `b` in `components` of host `two`, and remove this
            ?> components: {a: {command: ./a}, b: {command: ./b}} | two: {address: 127.0.0.2, components: [b]}
          (a host lists its components, in `hosts` at the top of the file)
        `gateway` is missing, but `hosts` needs it
          with all hosts on this machine: `gateway: {port: 7447}`
            ?> gateway: {port: 7447}
          with certificates, which `scl gateway keys` makes: `gateway: {port: 7447, certificates: ./keys}`
            ?> gateway: {port: 7447, certificates: ./keys}
          without certificates, so that everybody on the network can listen and send: `gateway: {port: 7447, insecure: true}`
            ?> gateway: {port: 7447, insecure: true}
        # components: {a: {command: ./a}, b: {command: ./b}}
        hosts:
          one: {address: 192.0.2.1, components: [a, b], insecure: true}
          two: {address: 192.0.2.2, components: [b]}
        gateway: {port: 80}
        unknown key `insecure` in host `one`
          `insecure` belongs into `gateway`
            ?> one: {address: 192.0.2.1, components: [a, b]} | gateway: {port: 80, insecure: true}
        component `b` is on two hosts, `one` and `two`
          remove it from `one`
            ?> one: {address: 192.0.2.1, components: [a], insecure: true}
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles:
          a:
            command: [./a, -v]
          b:
            command: ./b
        `profiles` has the entry of component `a` in place of a profile
          write the name of the profile above, like `simulation:`, and indent the entries
            ?> simulation: | a: | command: [./a, -v] | b: | command: ./b
          (`profiles` is a mapping from names of profiles to their entries of components)
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles: {a: {command: ./x}}
        `profiles` has the entry of component `a` in place of a profile
          write the name of the profile before it: `{simulation: {...}}`
          (`profiles` is a mapping from names of profiles to their entries of components)
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles:
          active: debug
          debug: {a: {cpu: 1}}
        `active` does not choose profile `debug`
          remove `active`
            ?> 
          (a profile is chosen at the start: `scl run --profile debug`)
    "##]].assert_eq(&all);
}

//! The language as scripts find it: the same in every run, and old words.

use super::world::said;

#[test]
fn tables_are_gone_through_in_one_order() {
    let code = "function sysCall_init()
        local t = { zeta = 1, alpha = 2, [3] = 3, mid = 4, [1] = 5, [true] = 6, ['10'] = 7 }
        local keys = {}
        for k in pairs(t) do keys[#keys + 1] = tostring(k) end
        print(table.concat(keys, ' '))
        keys = {}
        local k, v = next(t)
        while k do keys[#keys + 1] = tostring(k) k, v = next(t, k) end
        print(table.concat(keys, ' '))
        for k in pairs(t) do t[k] = nil end
        print(next(t))
        local own = setmetatable({}, { __pairs = function() return function(_, k) if not k then return 1, 2 end end end })
        for k, v in pairs(own) do print(k, v) end
    end";
    assert_eq!(said(code), ["true 1 3 10 alpha mid zeta", "true 1 3 10 alpha mid zeta", "nil", "1\t2"]);
}

#[test]
fn powers_are_those_of_this_program() {
    use sincro_math::elementary::pow;
    let code = "function sysCall_init()
        print(string.format('%.17g %.17g %.17g', 2.7^1.3, (-8)^(1/3), -2^2))
        print(2^3^2, 2^-1, ('4')^0.5, 7^2, load('return 10^3')())
        print(setmetatable({}, { __pow = function(a, b) return b end }) ^ 5)
    end";
    let said = said(code);
    let numbers: Vec<f64> = said[0].split(' ').map(|x| x.parse().unwrap_or(f64::NAN)).collect();
    assert_eq!((numbers[0], numbers[1].is_nan(), numbers[2]), (pow(2.7, 1.3).0, true, -4.0));
    assert_eq!(said[1..], ["512.0\t0.5\t2.0\t49.0\t1000.0", "5"]);
}

#[test]
fn random_numbers_are_those_of_the_seed() {
    let code =
        "function sysCall_init() print(math.random(), math.random(1000)) math.randomseed() print(math.random()) end";
    let (first, second) = (said(code), said(code));
    assert_eq!(first, second);
    assert_eq!(first[0].split('\t').next(), Some(first[1].as_str()));
}

#[test]
fn old_words_are_known() {
    let code = "function sysCall_init()
        print(math.pow(2, 10), math.log10(1000), math.atan2(0, -1) == math.pi, unpack({ 1, 2 }))
        print(table.getn({ 1, 2, 3 }), loadstring('return 4')(), math.mod(7, 4), table.maxn({ [5] = 1 }))
        print(os.time(), os.clock(), sim.getSystemTime())
    end";
    assert_eq!(said(code), ["1024.0\t3.0\ttrue\t1\t2", "3\t4\t3\t5", "0\t0.0\t0.0"]);
}

#[test]
fn caught_errors_are_texts_with_their_line() {
    let code = "function sysCall_init()
        print(pcall(sim.getObject, '/nothing'))
        print(pcall(function() local x = nil + 1 end))
        print(select(2, pcall(error, { 7 }))[1], select(2, pcall(error, 'plain', 0)))
        local co = coroutine.create(function() coroutine.yield(1) error('inside') end)
        print(coroutine.resume(co)) print(coroutine.resume(co)) print(coroutine.resume(co))
    end";
    let said = said(code);
    assert!(said[0].starts_with("false\t") && said[0].contains("Object does not exist: `/nothing`"), "{said:?}");
    assert_eq!(said[1], "false\tscript:3: attempt to perform arithmetic on a nil value");
    assert_eq!(said[2..4], ["7\tplain", "true\t1"]);
    assert!(said[4].starts_with("false\tscript:5: inside"), "{said:?}");
    assert_eq!(said[5], "false\tcannot resume dead coroutine");
}

#[test]
fn a_seed_with_a_fraction_is_taken_as_older_lua_does() {
    let code = "
        function sysCall_init()
            math.randomseed(1234.7)
            local a = math.random()
            math.randomseed(1234)
            print(a == math.random(), (pcall(math.randomseed, 0 / 0)))
        end";
    assert_eq!(said(code), ["true\tfalse"]);
}

#[test]
fn the_generator_of_the_simulator_is_that_of_the_script() {
    let code = "
        function sysCall_init()
            local seen, ok = {}, true
            for _ = 1, 400 do
                local a, b, c = math.random2(), math.random2(3), math.random2(-1, 1)
                ok = ok and a >= 0 and a < 1 and b >= 1 and b <= 3 and c >= -1 and c <= 1
                ok = ok and math.type(b) == 'integer' and math.type(c) == 'integer'
                seen[b], seen[10 + c] = true, true
            end
            print(ok, seen[1] and seen[2] and seen[3] and seen[9] and seen[10] and seen[11])
            math.randomseed2(7)
            local a = math.random2(1, 1000000)
            math.randomseed2(7)
            print(a == math.random2(1, 1000000), math.random2(5, 5), math.random2(0.5, 0.5))
            print(sim.getRandom(11) == sim.getRandom(11), sim.getRandom() ~= sim.getRandom())
            print(pcall(math.random2, 'x'))
        end";
    let said = said(code);
    assert_eq!(said[..3], ["true\ttrue", "true\t5\t0.5", "true\ttrue"]);
    assert!(said[3].starts_with("false\t") && said[3].contains("number expected"), "{said:?}");
}
